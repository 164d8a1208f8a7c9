#include "image/picture_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>

#include "image/png.h"

namespace aa {
namespace {

// ---- words ----
constexpr size_t kOrder[] = {1, 0, 2};  // green first: the other two are coded against it

int32_t wrapped(uint32_t v, int bits) { return bits == 8 ? int32_t(int8_t(uint8_t(v))) : int32_t(v); }

// MED: the edge detecting guess from west, north and north-west; in integers modulo 2^32.
int32_t med(int32_t west, int32_t north, int32_t northWest) {
    const int32_t high = std::max(west, north), low = std::min(west, north);
    if (northWest >= high) return low;
    if (northWest <= low) return high;
    return int32_t(uint32_t(west) + uint32_t(north) - uint32_t(northWest));
}

// What is left after steps 2 and 3, and back. `difference` holds the words of step 2.
class Residual {
  public:
    Residual(int width, int height, int bits, Guess guess)
        : width_(width), bits_(bits), guess_(guess), words_(size_t(width) * size_t(height)) {}
    int32_t guessAt(int x, int y) const {
        if (guess_ == Guess::zero) return 0;
        const int32_t* here = words_.data() + size_t(y) * size_t(width_) + x;
        if (y == 0) return x == 0 ? 0 : here[-1];
        return x == 0 ? here[-width_] : med(here[-1], here[-width_], here[-width_ - 1]);
    }
    int32_t fromWord(int x, int y, int32_t word) {
        const int32_t left = wrapped(uint32_t(word) - uint32_t(guessAt(x, y)), bits_);
        words_[size_t(y) * size_t(width_) + size_t(x)] = word;
        return left;
    }
    int32_t toWord(int x, int y, int32_t left) {
        return words_[size_t(y) * size_t(width_) + size_t(x)] =
                   wrapped(uint32_t(left) + uint32_t(guessAt(x, y)), bits_);
    }

  private:
    int width_, bits_;
    Guess guess_;
    std::vector<int32_t> words_;
};

// Word i of channel c (in the order of coding) after step 2. A picture without another is taken around mid-grey.
uint32_t base(const Words& green, const Words* other, size_t c, size_t i) {
    const size_t n = green.perChannel();
    uint32_t b = other ? other->values[c * n + i] : 0;
    if (c > 0)
        b += green.values[i] - (other ? other->values[i] : 0);
    else if (!other && green.bits == 8)
        b = 128;
    return b;
}

// ---- the model ----
constexpr int kClasses = 33, kNear = 14, kBefore = 5;

int classOf(int32_t v) { return int(std::bit_width(v < 0 ? 0u - uint32_t(v) : uint32_t(v))); }

// The chance of a 1 in 16 bits: the mean of one that learns fast and one that learns slowly.
struct Chance {
    uint16_t fast = 1 << 15, slow = 1 << 15;
    uint32_t one() const { return (uint32_t(fast) + slow) >> 1; }
    void learn(int bit) {
        if (bit)
            fast = uint16_t(fast + ((65535 - fast) >> 4)), slow = uint16_t(slow + ((65535 - slow) >> 7));
        else
            fast = uint16_t(fast - (fast >> 4)), slow = uint16_t(slow - (slow >> 7));
    }
};

class Model {
  public:
    Model(int width, int height) : width_(width), classes_{std::vector<uint8_t>(size_t(width) * size_t(height)), {}} {
        classes_[1] = classes_[0];
    }
    // To be called before every word, in the order of coding.
    void look(int channel, int x, int y) {
        if (x == 0 && y == 0 && channel > 0) std::swap(classes_[0], classes_[1]);
        const size_t at = size_t(y) * size_t(width_) + size_t(x);
        const uint8_t* here = classes_[0].data() + at;
        const int west = x > 0 ? here[-1] : 0, north = y > 0 ? here[-width_] : 0;
        const int northWest = x > 0 && y > 0 ? here[-width_ - 1] : 0;
        const int northEast = y > 0 && x + 1 < width_ ? here[-width_ + 1] : 0;
        const int sum = 2 * west + 2 * north + northWest + northEast;
        // Classes of a float reach 32; beyond the twelfth step all are large.
        near_ = sum < 8 ? sum : std::min(8 + (sum - 8) / 6, kNear - 1);
        before_ = channel == 0 ? 0 : std::min(1 + int(classes_[1][at]), kBefore - 1);
        place_ = &classes_[0][at];
    }
    Chance& more(int level) { return class_[size_t(before_)][size_t(near_)][size_t(level)]; }
    Chance& sign() { return sign_[size_t(before_)]; }
    Chance& second(int level) { return second_[size_t(before_)][size_t(level)]; }
    void was(int level) { *place_ = uint8_t(level); }

  private:
    int width_, near_ = 0, before_ = 0;
    uint8_t* place_ = nullptr;
    std::array<std::vector<uint8_t>, 2> classes_;  // of this channel and of the one before
    std::array<std::array<std::array<Chance, kClasses>, kNear>, kBefore> class_{};
    std::array<Chance, kBefore> sign_{};
    std::array<std::array<Chance, kClasses>, kBefore> second_{};
};

// ---- the coder ----
// The interval [low_, high_] of 32-bit numbers shrinks in proportion to the chances; leading bytes that agree are out.
uint32_t middle(uint32_t low, uint32_t high, uint32_t chance) {
    const uint32_t range = high - low;
    return low + (range >> 16) * chance + ((range & 0xffff) * chance >> 16);
}
class Encoder {
  public:
    void bit(int b, Chance& c) {
        put(b, std::clamp(c.one(), 32u, 65503u));
        c.learn(b);
    }
    void plain(int b) { put(b, 1 << 15); }
    std::vector<unsigned char> end() {
        for (int i = 0; i < 4; i++) out_.push_back(uint8_t(low_ >> 24)), low_ <<= 8;
        while (out_.size() > 1 && out_.back() == 0) out_.pop_back();  // the page reads zeros beyond the end
        return std::move(out_);
    }

  private:
    void put(int b, uint32_t chance) {
        const uint32_t mid = middle(low_, high_, chance);
        if (b)
            high_ = mid;
        else
            low_ = mid + 1;
        while (((low_ ^ high_) & 0xff000000u) == 0) {
            out_.push_back(uint8_t(high_ >> 24));
            low_ <<= 8, high_ = high_ << 8 | 255;
        }
    }
    uint32_t low_ = 0, high_ = 0xffffffffu;
    std::vector<unsigned char> out_;
};
class Decoder {
  public:
    explicit Decoder(std::span<const unsigned char> in) : in_(in) {
        for (int i = 0; i < 4; i++) next();
    }
    int bit(Chance& c) {
        const int b = get(std::clamp(c.one(), 32u, 65503u));
        c.learn(b);
        return b;
    }
    int plain() { return get(1 << 15); }

  private:
    void next() { code_ = code_ << 8 | (at_ < in_.size() ? in_[at_] : 0u), at_++; }
    int get(uint32_t chance) {
        const uint32_t mid = middle(low_, high_, chance);
        const int b = code_ <= mid;
        if (b)
            high_ = mid;
        else
            low_ = mid + 1;
        while (((low_ ^ high_) & 0xff000000u) == 0) {
            low_ <<= 8, high_ = high_ << 8 | 255;
            next();
        }
        return b;
    }
    std::span<const unsigned char> in_;
    size_t at_ = 0;
    uint32_t low_ = 0, high_ = 0xffffffffu, code_ = 0;
};

template <class Do>
void forWords(int width, int height, Do each) {
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) each(c, x, y, size_t(y) * size_t(width) + size_t(x));
}
}  // namespace

Words codeWords(const Rgb& encoded) {
    Words w{encoded.width(), encoded.height(), 8, {}};
    const auto codes = codesOf(encoded);
    const size_t n = w.perChannel();
    w.values.resize(3 * n);
    for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < n; i++) w.values[c * n + i] = codes[3 * i + kOrder[c]];
    return w;
}
Words floatWords(const Rgb& linear) {
    Words w{linear.width(), linear.height(), 32, {}};
    w.values.reserve(3 * w.perChannel());
    for (const size_t c : kOrder)
        for (int y = 0; y < w.height; y++)
            for (int x = 0; x < w.width; x++) {
                const uint32_t bits = std::bit_cast<uint32_t>(linear.c[c].at(x, y));
                w.values.push_back(bits >> 31 ? ~bits : bits | 0x80000000u);
            }
    return w;
}

std::vector<unsigned char> packed(const Words& p, const Words* other, Guess guess) {
    assert(!other || (other->width == p.width && other->height == p.height && other->bits == p.bits));
    Encoder out;
    Model model(p.width, p.height);
    Residual residual(p.width, p.height, p.bits, guess);
    const size_t n = p.perChannel();
    forWords(p.width, p.height, [&](int c, int x, int y, size_t i) {
        const int32_t word = wrapped(p.values[size_t(c) * n + i] - base(p, other, size_t(c), i), p.bits);
        const int32_t left = residual.fromWord(x, y, word);
        const int level = classOf(left);
        model.look(c, x, y);
        for (int k = 0; k <= level && k < p.bits; k++) out.bit(k < level, model.more(k));
        model.was(level);
        if (level == 0) return;
        out.bit(left < 0, model.sign());
        const uint32_t size = left < 0 ? 0u - uint32_t(left) : uint32_t(left);
        if (level > 1) out.bit(int(size >> (level - 2) & 1), model.second(level));
        for (int k = level - 3; k >= 0; k--) out.plain(int(size >> k & 1));
    });
    return out.end();
}

Words unpacked(std::span<const unsigned char> bytes, int width, int height, int bits, const Words* other, Guess guess) {
    Words p{width, height, bits, {}};
    const size_t n = p.perChannel();
    p.values.resize(3 * n);
    Decoder in(bytes);
    Model model(width, height);
    Residual residual(width, height, bits, guess);
    forWords(width, height, [&](int c, int x, int y, size_t i) {
        model.look(c, x, y);
        int level = 0;
        while (level < bits && in.bit(model.more(level))) level++;
        model.was(level);
        int32_t left = 0;
        if (level > 0) {
            const int negative = in.bit(model.sign());
            uint32_t size = 1;
            if (level > 1) size = size << 1 | uint32_t(in.bit(model.second(level)));
            for (int k = level - 3; k >= 0; k--) size = size << 1 | uint32_t(in.plain());
            left = int32_t(negative ? 0u - size : size);
        }
        const uint32_t word = uint32_t(residual.toWord(x, y, left)) + base(p, other, size_t(c), i);
        p.values[size_t(c) * n + i] = bits == 8 ? word & 255 : word;
    });
    return p;
}

double packedSize(const Words& p, const Words* other, Guess guess) {
    std::array<std::array<double, kClasses>, 3> counts{};
    Residual residual(p.width, p.height, p.bits, guess);
    const size_t n = p.perChannel();
    forWords(p.width, p.height, [&](int c, int x, int y, size_t i) {
        const int32_t word = wrapped(p.values[size_t(c) * n + i] - base(p, other, size_t(c), i), p.bits);
        counts[size_t(c)][size_t(classOf(residual.fromWord(x, y, word)))]++;
    });
    double bits = 0;
    for (const auto& channel : counts)
        for (int k = 0; k < kClasses; k++)
            if (const double count = channel[size_t(k)]; count > 0)
                bits += count * (k - std::log2(count / double(n)));  // a class, its sign and the bits after the first
    return bits / 8;
}

}  // namespace aa
