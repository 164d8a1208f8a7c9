// Which of two statements about the samples' places does a picture bear out?
//
// A pixel that a straight edge crosses says on which side of it its sample lay, and the mean says where the edge is: a
// point sample shows the bright side exactly where n . j > d, j being its place in the pixel (px from the centre, y
// down), n the edge's normal towards the bright side and d the edge's place along n. So two statements can be told
// apart by the pixels where they foretell different sides, and only by those. Edges that lie at few places in their
// pixels (cubes seen from the front) may leave none: then the picture cannot tell, and a fit over offsets that are not
// spread evenly (jitter.h) is wrong without its standard error showing it.
#pragma once
#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

namespace aa {

// Edge pixels of one picture, counted by direction of the edge, share of the bright side and side of the sample.
class EdgeVotes {
  public:
    static constexpr size_t kDirections = 16, kShares = 20;
    // `normal`: unit, towards the bright side; `share` of the bright side in the pixel, 0 to 1.
    void add(glm::dvec2 normal, double share, bool bright);
    size_t count(size_t direction, size_t share, bool bright) const { return counts_[direction][share][bright]; }
    // The edge's normal, turned to the half plane of y >= 0, and its share as counted.
    static glm::dvec2 normalOf(size_t direction);
    static double shareOf(size_t share) { return (double(share) + 0.5) / double(kShares); }

  private:
    std::array<std::array<std::array<uint32_t, 2>, kShares>, kDirections> counts_{};
};

// Between which places in a pixel the mean picture was taken: its whole area, or the samples of the frames averaged.
class MeanOf {
  public:
    MeanOf() = default;  // the area of the pixel
    explicit MeanOf(std::span<const glm::dvec2> positionsPx);
    // Whether a sample at `placePx` shows the bright side of such an edge; nothing where it lies too near to say.
    std::optional<bool> bright(size_t direction, size_t share, glm::dvec2 placePx) const;
    // Share of the edge pixels that show what a sample at `placePx` foretells, of those for which it foretells
    // anything.
    double borneOut(const EdgeVotes& votes, glm::dvec2 placePx) const;

  private:
    std::array<std::vector<double>, EdgeVotes::kDirections> sorted_;  // along each direction's normal
};

struct Contest {
    size_t differing = 0;  // edge pixels for which the two statements foretell different sides
    size_t forRival = 0;   // of these, how many show the rival's
    void add(const EdgeVotes& votes, const MeanOf& stated, glm::dvec2 statedPx, const MeanOf& rival,
             glm::dvec2 rivalPx);
    // Enough pixels to tell at all, and three in four for the rival.
    bool told() const;
    bool rivalWins() const { return told() && 4 * forRival >= 3 * differing; }
};

}  // namespace aa
