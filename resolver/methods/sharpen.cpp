#include "methods/sharpen.h"

#include <stdexcept>

namespace aa {

Sharpen sharpenByName(const std::string& text) {
    for (const auto& choice : kSharpens)
        if (choice.text == text) return choice.value;
    throw std::logic_error("sharpenByName: expected one of kSharpens, found '" + text + "'");
}

void sharpen(const Rgb& image, Sharpen filter, Space space, const Exec& exec, Rgb& out) {
    if (out.width() != image.width() || out.height() != image.height()) out = Rgb(image.width(), image.height());
    const SharpenArgs args{
        view(image),   view(out), image.stride(),
        image.width(), filter,    space == Space::encoded ? SharpenRange::display : SharpenRange::neighbourhood};
    runKernel(sharpenKernelsFor(exec).sharpen, exec, args, image.height());
}

void sharpenLuma(const Rgb& image, float amount, const Exec& exec, Rgb& out) {
    const SharpenArgs args{
        view(image), view(out), image.stride(), image.width(), Sharpen::lumaPost, SharpenRange::positive, amount};
    runKernel(sharpenKernelsFor(exec).sharpen, exec, args, image.height());
}

}  // namespace aa
