// Metrics of a sequence: what a viewer sees of it over time is more than what its frames show one by one. They are fed
// frame by frame and keep what they need, so that memory does not grow with the number of frames.
#pragma once
#include <memory>
#include <vector>

#include "image/plane.h"
#include "kernels/dispatch.h"
#include "metrics/display_model.h"

namespace aa {

// How the sequence is shown.
struct Viewing {
    const DisplayModel* display = &displayModels().front();
    double framesPerSecond = 30;
};
struct SequenceSetting {
    int width = 0, height = 0;
    Viewing viewing = {};
    float exposure = 0;  // EV of linear light, for displays that are fed it
    bool still = false;  // one picture alone: nothing moves and nothing flickers
    bool withMaps = false;
};
struct SequencePicture {
    const Rgb& encoded;
    const Rgb* linear = nullptr;  // as in ImagePair
};

// A sequence that is judged. It belongs to the reference that made it.
class SequenceTest {
  public:
    virtual ~SequenceTest() = default;
    // The frame that corresponds to the reference's latest. Returns one value per figure: those of a sequence in which
    // every frame differs as this one does.
    virtual std::vector<double> add(const SequencePicture& frame, const Exec& exec) = 0;
    virtual std::vector<double> overall() const = 0;       // one value per figure, of all frames so far
    virtual PlaneF latestMap(const Exec& exec) const = 0;  // where the latest frame differs; needs withMaps
};
// What it is held against; one serves any number of tests.
class SequenceReference {
  public:
    virtual ~SequenceReference() = default;
    virtual void add(const SequencePicture& frame, const Exec& exec) = 0;
    virtual std::unique_ptr<SequenceTest> test() = 0;
};

}  // namespace aa
