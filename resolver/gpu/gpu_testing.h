// Test support: tests that need a graphics device, which count as skipped where there is none.
#pragma once
#include <gtest/gtest.h>

#include "gpu/device.h"

namespace aa::gpu {

class DeviceTest : public ::testing::Test {
  protected:
    void SetUp() override {
#ifdef AA_SANITIZED
        GTEST_SKIP() << "AddressSanitizer judges the driver's memory, too";
#endif
        try {
            if (listDevices().empty()) GTEST_SKIP() << "no Vulkan device here";
        } catch (const DeviceError& e) {
            GTEST_SKIP() << e.what();
        }
        open();
    }
    virtual void open() = 0;  // what the tests use; called where there is a device
};

}  // namespace aa::gpu
