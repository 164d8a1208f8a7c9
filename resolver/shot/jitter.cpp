#include "shot/jitter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "image/error.h"
#include "shot/patterns.h"

namespace aa {
namespace {
constexpr double kGaussianSigmaPx = 0.2575;  // [Stejmar n.d., listing 4.2], which multiplies by its square by mistake
constexpr double kListedScalePx = kGaussianSigmaPx * kGaussianSigmaPx;  // that mistake: what its figures were made with

double frac(double v) { return v - std::floor(v); }
double clampToPixel(double v) { return std::clamp(v, -0.5, 0.5); }

// Jimenez's interleaved gradient noise as the Vulkan book jitters with it.
double interleavedGradient(double x, double y, double n) {
    return frac(52.9829189 * frac(0.06711056 * (x + 5.588238 * n) + 0.00583715 * (y + 5.588238 * n)));
}

// O'Neill's PCG32: the same numbers on every machine.
class Pcg32 {
  public:
    explicit Pcg32(uint64_t sequence) : increment_(sequence << 1 | 1) {
        next();
        state_ += 0x853C49E6748FEA9Bull;
        next();
    }
    uint32_t next() {
        const uint64_t old = state_;
        state_ = old * 6364136223846793005ull + increment_;
        const auto shifted = uint32_t(((old >> 18) ^ old) >> 27);
        const auto rotation = uint32_t(old >> 59);
        return shifted >> rotation | shifted << (-rotation & 31);
    }
    double uniform() { return next() / 4294967296.0; }

  private:
    uint64_t state_ = 0, increment_;
};

// The polar method [Marsaglia 1964], one generator per frame.
glm::dvec2 gaussian(uint64_t n, double scalePx) {
    Pcg32 generator(n);
    for (;;) {
        const double a = 2 * generator.uniform() - 1, b = 2 * generator.uniform() - 1, s = a * a + b * b;
        if (!(s > 0 && s < 1)) continue;
        const double f = scalePx * std::sqrt(-2 * std::log(s) / s);
        return {clampToPixel(f * a), clampToPixel(f * b)};
    }
}

constexpr glm::dvec2 kQuadrants[] = {{-0.25, -0.25}, {-0.25, 0.25}, {0.25, -0.25}, {0.25, 0.25}};
// The INSIDE lists are published with y up.
constexpr glm::dvec2 kUniform4[] = {{-0.25, 0.25}, {0.25, -0.25}, {0.25, 0.25}, {-0.25, -0.25}};
constexpr glm::dvec2 kRotated4[] = {{-0.125, 0.375}, {0.375, 0.125}, {0.125, -0.375}, {-0.375, -0.125}};
constexpr glm::dvec2 kSmaaT2x[] = {{0.25, 0.25}, {-0.25, -0.25}};
constexpr glm::dvec2 kSmaa4x[] = {{0.125, -0.125}, {-0.125, 0.125}};  // [Jimenez 2012], published with y up
// T2MSAA: (d, -d) and (-d, d) in turn. [Stejmar n.d., 4.4.2] has d = 0.25 px, its tables 5.18 and 5.19 the two others,
// with which the four samples of two frames lie in rows and columns of their own.
constexpr glm::dvec2 kT2msaaDirection[] = {{1, -1}, {-1, 1}};
constexpr uint32_t kReverseRadix3[] = {0, 2, 1};  // MATLAB's RR2 in base 3; the identity in base 2

glm::dvec2 point(std::string_view sequence, uint64_t start, uint64_t n, uint64_t period) {
    const auto fromUnit = [](double u, double v) { return glm::dvec2(u - 0.5, v - 0.5); };
    const uint64_t m = n + start;
    if (sequence == "none") return {0, 0};
    if (sequence == "halton23" || sequence == "halton23zero")
        return fromUnit(radicalInverse(2, m), radicalInverse(3, m));
    if (sequence == "thesis") return fromUnit(radicalInverse(2, n), radicalInverse(3, n, kReverseRadix3));
    if (sequence == "hammersley") return fromUnit(double(n) / double(period), radicalInverse(2, n));
    if (sequence == "r2")  // Roberts: powers of the inverse plastic number
        return fromUnit(frac(0.5 + double(n) * 0.7548776662466927), frac(0.5 + double(n) * 0.5698402909980532));
    if (sequence == "ign") return fromUnit(interleavedGradient(1, 1, double(n)), interleavedGradient(1, 2, double(n)));
    if (sequence == "gaussian") return gaussian(n, kGaussianSigmaPx);
    if (sequence == "quadrant") return kQuadrants[n % 4];
    if (sequence == "quadrantGaussian" || sequence == "quadrantGaussianVariance") {
        const double scalePx = sequence == "quadrantGaussian" ? kGaussianSigmaPx : kListedScalePx;
        const glm::dvec2 q = kQuadrants[n % 4], g = gaussian(n, scalePx);
        return {clampToPixel(q.x + g.x), clampToPixel(q.y + g.y)};
    }
    if (sequence == "insideUniform4") return kUniform4[n % 4];
    if (sequence == "insideRotated4") return kRotated4[n % 4];
    if (sequence == "msaa8") return glm::dvec2(kD3d8[n % 8].x, kD3d8[n % 8].y) / 16.0;
    if (sequence == "smaa4x") return kSmaa4x[n % 2];
    if (sequence == "t2msaa") return kT2msaaDirection[n % 2] * 0.25;
    if (sequence == "t2msaa1875") return kT2msaaDirection[n % 2] * 0.1875;
    if (sequence == "t2msaa125") return kT2msaaDirection[n % 2] * 0.125;
    return kSmaaT2x[n % 2];
}
}  // namespace

double radicalInverse(uint32_t base, uint64_t index, const uint32_t* permutation) {
    double digits = 0, scale = 1;
    for (; index > 0; index /= base) {
        const auto digit = uint32_t(index % base);
        digits = digits * base + (permutation ? permutation[digit] : digit);
        scale *= base;
    }
    return digits / scale;
}

const std::vector<JitterInfo>& jitterSequences() {
    static const std::vector<JitterInfo> table = {
        {"none", "every sample at the pixel centre", 0, 1},
        {"halton23", "Halton, bases 2 and 3, from index 1", 1, 0},
        {"halton23zero", "Halton, bases 2 and 3, from index 0 (contains the pixel corner)", 0, 0},
        {"thesis", "MATLAB haltonset(2) with RR2 scrambling, from index 0", 0, 0},
        {"hammersley", "(n / period, radical inverse to base 2)", 0, 0},
        {"r2", "Roberts' additive recurrence", 0, 0},
        {"ign", "interleaved gradient noise", 0, 0},
        {"gaussian", "normal distribution, sigma 0.2575 px, clipped to the pixel", 0, 0},
        {"quadrant", "the four quarter points in turn", 0, 4},
        {"quadrantGaussian", "quarter points plus the normal distribution (asaa)", 0, 0},
        {"quadrantGaussianVariance",
         "labelled variant: quarter points plus a normal distribution of 0.0663 px, the square of sigma, as [Stejmar "
         "n.d.] "
         "lists it",
         0, 0},
        {"insideUniform4", "four quarter points, helix order", 0, 4},
        {"insideRotated4", "rotated grid of four", 0, 4},
        {"msaa8", "the Direct3D 8x pattern in turn", 0, 8},
        {"smaaT2x", "(+.25, +.25) and (-.25, -.25) in turn", 0, 2},
        {"smaa4x", "(+.125, -.125) and (-.125, +.125) in turn, for sub-samples d3d2", 0, 2},
        {"t2msaa", "(+.25, -.25) and (-.25, +.25) in turn, for sub-samples d3d2", 0, 2},
        {"t2msaa1875", "(+.1875, -.1875) and (-.1875, +.1875) in turn, for sub-samples d3d2", 0, 2},
        {"t2msaa125", "(+.125, -.125) and (-.125, +.125) in turn, for sub-samples d3d2", 0, 2},
    };
    return table;
}

const JitterInfo& jitterSequence(std::string_view name) {
    std::string known;
    for (const auto& s : jitterSequences()) {
        if (s.name == name) return s;
        known += (known.empty() ? "" : ", ") + std::string(s.name);
    }
    throw UsageError("jitter sequence '" + std::string(name) + "': expected one of " + known);
}

glm::dvec2 jitterPx(const JitterSpec& spec, uint64_t index) {
    const JitterInfo& info = jitterSequence(spec.sequence);
    if (spec.start >= 0 && spec.start != info.start && spec.sequence != "halton23")
        throw UsageError("jitter sequence '" + std::string(info.name) + "' starts at index " +
                         std::to_string(info.start) + "; only halton23 takes another start");
    if (spec.period < 1) throw UsageError("jitter period " + std::to_string(spec.period) + ": expected at least 1");
    const auto start = uint64_t(spec.start >= 0 ? spec.start : info.start), period = uint64_t(spec.period);
    glm::dvec2 j = point(info.name, start, index % period, period);
    if (spec.centred) {
        glm::dvec2 sum(0);
        for (uint64_t n = 0; n < period; n++) sum += point(info.name, start, n, period);
        j -= sum / double(period);
    }
    return j;
}

}  // namespace aa
