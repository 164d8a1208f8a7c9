#include "report/gallery.h"

#include <algorithm>
#include <cmath>

#include "image/error.h"
#include "image/inputs.h"
#include "image/io.h"
#include "metrics/maps.h"

namespace aa {
namespace fs = std::filesystem;
namespace {

const FrameResult* find(const MethodResult& m, int frame) {
    for (const auto& f : m.frames)
        if (f.frame == frame && !f.image.empty()) return &f;
    return nullptr;
}

LoadedImage loadOfItsSize(const fs::path& file, const RunResults& run) {
    for (const char* ending : {".png", ".exr"}) noteInput(fs::path(file).replace_extension(ending));  // one picture
    LoadedImage image = readImage(file);
    if (image.rgb.width() != run.width || image.rgb.height() != run.height)
        throw InputError(file.string() + ": expected " + std::to_string(run.width) + "x" + std::to_string(run.height) +
                         " as results.json says, found " + std::to_string(image.rgb.width()) + "x" +
                         std::to_string(image.rgb.height()) + "; run the shot again");
    return image;
}
Rgb loadEncoded(const fs::path& file, const RunResults& run, const Exec& exec) {
    LoadedImage image = loadOfItsSize(file, run);
    const Protocol& p = run.protocol;
    Rgb encoded;
    if (image.space == FileSpace::encoded)
        encoded = std::move(image.rgb);
    else
        encode(image.rgb, image.displayReferred ? p.display.transferOnly() : p.display, exec, encoded);
    if (p.eightBit) quantise8(encoded, exec);
    return encoded;
}
LinearPicture loadLinear(const fs::path& file, const RunResults& run) {
    LoadedImage image = loadOfItsSize(file, run);
    if (image.space == FileSpace::encoded)
        throw InputError(file.string() + ": expected linear light, found 8-bit codes; run with --write exr");
    return {std::move(image.rgb), image.displayReferred};
}
const std::string& imageOf(const RunResults& run, const MethodResult& m, const fs::path& folder, int frame) {
    const FrameResult* f = find(m, frame);
    if (!f)
        throw InputError(folder.string() + ": no image of frame " + std::to_string(frame) + " by '" + m.text +
                         "'; choose a frame that was written, or " + howToWriteAll(run));
    return f->image;
}

// Sums over any window in constant time.
class SummedArea {
  public:
    template <class Value>
    SummedArea(int width, int height, Value value) : stride_(size_t(width) + 1), sum_(stride_ * (size_t(height) + 1)) {
        for (int y = 0; y < height; y++) {
            double row = 0;
            for (int x = 0; x < width; x++) {
                row += value(x, y);
                sum_[(size_t(y) + 1) * stride_ + size_t(x) + 1] = sum_[size_t(y) * stride_ + size_t(x) + 1] + row;
            }
        }
    }
    double mean(const Window& w) const {
        const auto at = [&](int x, int y) { return sum_[size_t(y) * stride_ + size_t(x)]; };
        const double sum =
            at(w.x + w.width, w.y + w.height) - at(w.x, w.y + w.height) - at(w.x + w.width, w.y) + at(w.x, w.y);
        return std::max(0.0, sum) / (double(w.width) * w.height);
    }

  private:
    size_t stride_;
    std::vector<double> sum_;
};

// A window and what tells it from others.
struct Candidate {
    Window window;
    std::vector<double> rms;        // of each method's error, or of all differences alone; later about its mean
    double interest = 0;            // the spread of these, or the one
    double alongX = 0, alongY = 0;  // direction of its edges by twice the angle, shorter where there are many
};

std::vector<Candidate> candidatesOf(const Pictures& p, const Window& within, int width, int height) {
    std::vector<Candidate> all;
    // A quarter of the window is a fine enough step: the window around a feature still holds all of it.
    const int stepX = std::max(1, width / 4), stepY = std::max(1, height / 4);
    for (int y = within.y; y + height <= within.y + within.height; y += stepY)
        for (int x = within.x; x + width <= within.x + within.width; x += stepX)
            all.push_back({{x, y, width, height}, {}});
    const int w = p.methods[0].width(), h = p.methods[0].height();
    const auto add = [&](auto squares) {
        const SummedArea sums(w, h, squares);
        for (Candidate& c : all) c.rms.push_back(std::sqrt(sums.mean(c.window)));
    };
    if (!p.truth.empty()) {
        for (const Rgb& m : p.methods) add([&](int x, int y) { return squaredDifference(m, p.truth, x, y); });
    } else {
        add([&](int x, int y) {
            double sum = 0;
            for (size_t i = 0; i < p.methods.size(); i++)
                for (size_t k = 0; k < i; k++) sum += squaredDifference(p.methods[i], p.methods[k], x, y);
            return sum;
        });
    }
    for (Candidate& c : all) {
        if (c.rms.size() == 1) {
            c.interest = c.rms[0];
            continue;
        }
        double mean = 0, squares = 0;
        for (const double v : c.rms) mean += v / double(c.rms.size());
        for (double& v : c.rms) v -= mean, squares += v * v;
        c.interest = std::sqrt(squares / double(c.rms.size()));
    }
    std::erase_if(all, [](const Candidate& c) { return c.interest <= 1e-6; });
    // The structure tensor of luma [Foerstner 1987].
    const Rgb& picture = p.truth.empty() ? p.methods[0] : p.truth;
    const auto luma = [&](int x, int y) {
        return (picture.c[0].clamped(x, y) + 2 * picture.c[1].clamped(x, y) + picture.c[2].clamped(x, y)) / 4.0;
    };
    const auto gradient = [&](int x, int y) {
        return std::pair(luma(x + 1, y) - luma(x - 1, y), luma(x, y + 1) - luma(x, y - 1));
    };
    const auto sums = [&](auto of) {
        return SummedArea(w, h, [&](int x, int y) {
            const auto [gx, gy] = gradient(x, y);
            return of(gx, gy);
        });
    };
    const SummedArea xx = sums([](double gx, double) { return gx * gx; }),
                     yy = sums([](double, double gy) { return gy * gy; }),
                     diagonal = sums([](double gx, double gy) { return (gx + gy) * (gx + gy); });
    for (Candidate& c : all) {
        const double x = xx.mean(c.window), y = yy.mean(c.window), energy = x + y;
        if (energy <= 0) continue;
        c.alongX = (x - y) / energy;
        c.alongY = (diagonal.mean(c.window) - energy) / energy;
    }
    return all;
}

// From 0, nothing in common, to 1: by how the methods rank there and by the direction of the edges.
double likeness(const Candidate& a, const Candidate& b) {
    double product = 0, squareA = 0, squareB = 0;
    for (size_t i = 0; i < a.rms.size(); i++) {
        product += a.rms[i] * b.rms[i];
        squareA += a.rms[i] * a.rms[i], squareB += b.rms[i] * b.rms[i];
    }
    const double ranks = std::max(0.0, product / std::sqrt(squareA * squareB));
    const double edges = 1 - std::hypot(a.alongX - b.alongX, a.alongY - b.alongY) / 2;
    return (ranks + edges) / 2;
}
}  // namespace

std::vector<int> framesWithPictures(const RunResults& run) {
    std::vector<int> frames;
    if (run.methods.empty()) return frames;
    for (const auto& f : run.methods[0].frames)
        if (std::all_of(run.methods.begin(), run.methods.end(), [&](const auto& m) { return find(m, f.frame); }))
            frames.push_back(f.frame);
    std::sort(frames.begin(), frames.end());
    return frames;
}

std::string howToWriteAll(const RunResults& run) {
    return std::string("run again with ") + (run.wrotePictures() ? "" : "--write exr ") + "--write-frames all";
}

Pictures loadPictures(const RunResults& run, const fs::path& folder, int frame, const Exec& exec) {
    Pictures p;
    p.frame = frame;
    p.region = run.protocol.region;
    for (const auto& m : run.methods)
        p.methods.push_back(loadEncoded(folder / imageOf(run, m, folder, frame), run, exec));
    if (const auto truth = run.truthImages.find(frame); truth != run.truthImages.end())
        p.truth = loadEncoded(folder / truth->second, run, exec);
    return p;
}

LinearPictures loadLinearPictures(const RunResults& run, const fs::path& folder, int frame) {
    LinearPictures p;
    for (const auto& m : run.methods) p.methods.push_back(loadLinear(folder / imageOf(run, m, folder, frame), run));
    if (const auto truth = run.truthImages.find(frame); truth != run.truthImages.end())
        p.truth = loadLinear(folder / truth->second, run);
    return p;
}

std::vector<Window> mostTellingWindows(const Pictures& pictures, int width, int height, int count) {
    const Window within =
        pictures.region.value_or(Window{0, 0, pictures.methods[0].width(), pictures.methods[0].height()});
    width = std::min(width, within.width), height = std::min(height, within.height);
    std::vector<Candidate> candidates = candidatesOf(pictures, within, width, height);
    // What is like a window that was chosen, or near it, counts less: a quarter at least of each stays.
    constexpr double kLeast = 0.25;
    const double far = std::hypot(within.width, within.height) / 6;
    std::vector<Window> chosen;
    while (int(chosen.size()) < count && !candidates.empty()) {
        const Candidate best =
            *std::max_element(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
                return a.interest < b.interest;  // the first of equals
            });
        chosen.push_back(best.window);
        std::erase_if(candidates, [&](const Candidate& c) { return c.window.overlaps(best.window); });
        for (Candidate& c : candidates) {
            const double apart = std::hypot(c.window.x - best.window.x, c.window.y - best.window.y) / far;
            c.interest *= kLeast + (1 - kLeast) * (1 - likeness(c, best));
            c.interest *= kLeast + (1 - kLeast) * (1 - std::exp(-apart * apart));
        }
    }
    std::sort(chosen.begin(), chosen.end(),
              [](const Window& a, const Window& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
    return chosen;
}

std::vector<Window> tellingCrops(const Pictures& pictures, int count) {
    return mostTellingWindows(pictures, kTellingCropPx, kTellingCropPx, count);
}

}  // namespace aa
