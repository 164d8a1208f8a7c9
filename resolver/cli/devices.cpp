#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/cli.h"
#include "gpu/device.h"
#include "image/json_text.h"

namespace aa {

void addDevices(CommandLine& line, Context&) {
    auto asJson = std::make_shared<bool>(false);
    Command c = line.command("devices", "The graphics devices that --device can name");
    c.flag("--json", *asJson, "print JSON");
    c.run([asJson] {
        const auto devices = gpu::listDevices();
        if (*asJson) {
            nlohmann::ordered_json all = nlohmann::json::array();
            for (const auto& d : devices)
                all.push_back({{"index", d.index},
                               {"name", d.name},
                               {"kind", d.kind},
                               {"driver", d.driver},
                               {"vulkan", d.api},
                               {"memoryBytes", d.memoryBytes},
                               {"usable", d.lacks.empty()},
                               {"lacks", d.lacks}});
            std::cout << jsonText(all, 2) << "\n";
            return;
        }
        if (devices.empty())
            std::puts("no device: a Vulkan loader, but no driver (mesa-vulkan-drivers has one in software)");
        for (const auto& d : devices) {
            std::printf("vulkan:%zu  %s  (%s, %s, Vulkan %s, %.1f GiB)\n", d.index, d.name.c_str(), d.kind.c_str(),
                        d.driver.c_str(), d.api.c_str(), double(d.memoryBytes) / (1 << 30));
            if (!d.lacks.empty()) std::printf("          cannot run the shaders: it lacks %s\n", d.lacks.c_str());
            if (d.isCpu()) std::puts("          software on the processor: for checking, its times are no card's");
        }
    });
}

}  // namespace aa
