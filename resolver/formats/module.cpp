// Pictures that are neither PNG nor EXR, through OpenImageIO: a library of its own because OpenImageIO brings hundreds
// of others, whose loading alone costs more than most commands do.
#include "formats/module.h"

#include <OpenImageIO/imageio.h>

#include <memory>
#include <type_traits>

using OIIO::ImageInput;

#define AA_EXPORT extern "C" __attribute__((visibility("default")))

AA_EXPORT void* aaOpenPicture2(const char* file, AaPicture* picture) {
    try {
        OIIO::ImageSpec straight;
        straight.attribute("oiio:UnassociatedAlpha", 1);
        auto in = ImageInput::open(file, &straight);
        if (!in) {
            OIIO::geterror();
            return nullptr;
        }
        const OIIO::ImageSpec& spec = in->spec();
        *picture = {spec.width,         spec.height,
                    spec.nchannels,     spec.format.is_floating_point(),
                    spec.alpha_channel, spec.get_int_attribute("Orientation", 1)};
        return in.release();
    } catch (...) {  // nothing may pass the border
        return nullptr;
    }
}
AA_EXPORT int aaReadPicture2(void* opened, int channels, float* pixels) {
    try {
        auto* in = static_cast<ImageInput*>(opened);
        if (in->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, pixels)) return 1;
        in->geterror();
        return 0;
    } catch (...) {
        return 0;
    }
}
AA_EXPORT void aaClosePicture2(void* opened) { delete static_cast<ImageInput*>(opened); }

static_assert(std::is_same_v<decltype(&aaOpenPicture2), AaOpenPicture> &&
              std::is_same_v<decltype(&aaReadPicture2), AaReadPicture> &&
              std::is_same_v<decltype(&aaClosePicture2), AaClosePicture>);
