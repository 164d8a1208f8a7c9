// The shapes of a synthetic scene where they are at one time, and which of them a row of pixels meets.
#pragma once
#include "shot/synth/synth.h"

namespace aa {

struct Placed {
    const SynthShape* shape;
    Region region;
    Bounds bounds;
};
std::vector<Placed> placedAt(const std::vector<SynthShape>& shapes, double time);
const Placed* frontMost(const std::vector<Placed>& frontToBack, glm::dvec2 p);  // null: none holds the point

// For each row of a picture the shapes whose bounds come within `reachPx` of it, front to back.
std::vector<std::vector<const Placed*>> shapesOfRows(const std::vector<Placed>& frontToBack, int height,
                                                     double reachPx);

// One row of pixels. All that is asked lies within `reachPx` of a pixel of it.
class PlacedRow {
  public:
    PlacedRow(const std::vector<const Placed*>& frontToBack, int y, int width, double reachPx);
    // Whether some shape's outline may come within the reach of pixel x; where none does, one shape, or none, is in
    // front of everything there.
    bool isCrossed(int x) const { return crossed_[size_t(x)]; }
    // Those whose bounds may come within the reach of pixel x, front to back.
    const std::vector<const Placed*>& near(int x) const { return blocks_[size_t(x) / kBlock]; }
    const Placed* frontMost(int x, glm::dvec2 p) const;

  private:
    static constexpr size_t kBlock = 64;  // pixels that share a list
    void addEdge(glm::dvec2 a, glm::dvec2 b, double top, double bottom);
    void addCircle(const Disc& disc, double top, double bottom);
    void cross(double fromX, double toX);
    double reachPx_;
    std::vector<char> crossed_;
    std::vector<std::vector<const Placed*>> blocks_;
};

}  // namespace aa
