#include "report/gallery.h"

#include <algorithm>
#include <cmath>

#include "image/error.h"
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
const std::string& imageOf(const MethodResult& m, const fs::path& folder, int frame) {
    const FrameResult* f = find(m, frame);
    if (!f)
        throw InputError(folder.string() + ": no image of frame " + std::to_string(frame) + " by '" + m.text +
                         "'; run with --write exr and choose a frame that was written");
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

double variance(const std::vector<double>& v) {
    double mean = 0, sum = 0;
    for (const double x : v) mean += x / double(v.size());
    for (const double x : v) sum += (x - mean) * (x - mean);
    return sum / double(v.size());
}

// How much a window tells; see the header.
class Interest {
  public:
    explicit Interest(const Pictures& p) {
        const int w = p.methods[0].width(), h = p.methods[0].height();
        errors_ = !p.truth.empty();
        if (errors_) {
            for (const Rgb& m : p.methods)
                sums_.emplace_back(w, h, [&](int x, int y) { return squaredDifference(m, p.truth, x, y); });
        } else {
            sums_.emplace_back(w, h, [&](int x, int y) {
                double sum = 0;
                for (size_t i = 0; i < p.methods.size(); i++)
                    for (size_t k = 0; k < i; k++) sum += squaredDifference(p.methods[i], p.methods[k], x, y);
                return sum;
            });
        }
    }
    double of(const Window& window) const {
        if (sums_.size() == 1) return sums_[0].mean(window);
        std::vector<double> rms;
        for (const auto& s : sums_) rms.push_back(std::sqrt(s.mean(window)));
        return variance(rms);
    }

  private:
    bool errors_ = false;
    std::vector<SummedArea> sums_;
};
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

Pictures loadPictures(const RunResults& run, const fs::path& folder, int frame, const Exec& exec) {
    Pictures p;
    p.frame = frame;
    p.region = run.protocol.region;
    for (const auto& m : run.methods) p.methods.push_back(loadEncoded(folder / imageOf(m, folder, frame), run, exec));
    if (const auto truth = run.truthImages.find(frame); truth != run.truthImages.end())
        p.truth = loadEncoded(folder / truth->second, run, exec);
    return p;
}

LinearPictures loadLinearPictures(const RunResults& run, const fs::path& folder, int frame) {
    LinearPictures p;
    for (const auto& m : run.methods) p.methods.push_back(loadLinear(folder / imageOf(m, folder, frame), run));
    if (const auto truth = run.truthImages.find(frame); truth != run.truthImages.end())
        p.truth = loadLinear(folder / truth->second, run);
    return p;
}

std::vector<Window> mostTellingWindows(const Pictures& pictures, int width, int height, int count) {
    const Window within =
        pictures.region.value_or(Window{0, 0, pictures.methods[0].width(), pictures.methods[0].height()});
    width = std::min(width, within.width), height = std::min(height, within.height);
    const Interest interest(pictures);
    struct Candidate {
        double interest;
        Window window;
    };
    std::vector<Candidate> candidates;
    // A quarter of the window is a fine enough step: the window around a feature still holds all of it.
    const int stepX = std::max(1, width / 4), stepY = std::max(1, height / 4);
    for (int y = within.y; y + height <= within.y + within.height; y += stepY)
        for (int x = within.x; x + width <= within.x + within.width; x += stepX) {
            const Window window{x, y, width, height};
            if (const double i = interest.of(window); i > 1e-12) candidates.push_back({i, window});
        }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.interest > b.interest; });
    std::vector<Window> chosen;
    for (const auto& c : candidates) {
        if (int(chosen.size()) == count) break;
        if (std::none_of(chosen.begin(), chosen.end(), [&](const Window& o) { return o.overlaps(c.window); }))
            chosen.push_back(c.window);
    }
    std::sort(chosen.begin(), chosen.end(),
              [](const Window& a, const Window& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
    return chosen;
}

}  // namespace aa
