// Measures the methods of a run, frame by frame, against the truth (or the method that stands in for it) and over time.
#pragma once
#include <memory>
#include <mutex>

#include "methods/driver.h"
#include "metrics/maps.h"
#include "metrics/temporal.h"
#include "study/results.h"
#include "study/run.h"

namespace aa {

class Judge {
  public:
    Judge(const Manifest& manifest, const RunOptions& options, bool overTime);
    // The next frame, prepared as the methods see it, and its truth or null. Frames of a static shot share one truth:
    // encoded once. `standIn`: the method, resolved for this frame, that the others are held against instead.
    void look(const Frame& frame, const std::shared_ptr<const Truth>& truth, const RunningMethod* standIn);
    // The reference of that frame, the whole picture; null without truth.
    const Reference* reference() const { return reference_ ? &*reference_ : nullptr; }
    // What is measured of it: all, or the region. Only where there is one.
    const Reference& measured() const { return region_ ? *region_ : *reference_; }
    // Figures of what method `k` gave for it; of the stand-in none, which would be held against itself.
    // Where its figures are `known`, only the sums that the whole run needs are made again. Throws InputError where
    // they are not those of this image. Several methods may be judged at a time.
    FrameResult judge(size_t k, const RunningMethod& method, const ResolveSeconds& seconds,
                      const FrameResult* known = nullptr);
    // Once all methods are judged: squared error where history was rejected, of every method that keeps the mask (one
    // with a fill) and of its peers without or with another fill, which reject the same pixels.
    void judgeRejected(const std::vector<RunningMethod>& methods, std::vector<MethodResult>& results) const;
    // Whether that may read the picture of method `k`.
    static bool isReadLater(const std::vector<RunningMethod>& methods, size_t k);
    // Fills what holds for the whole run; `fromReset`: the first frame had no history.
    void finish(RunResults& results, bool fromReset) const;
    const std::vector<TileErrors>& errors() const { return errors_; }
    // Where method `k` differs in the latest frame, as a metric of a sequence sees it; empty where it was not measured.
    PlaneF sequenceMap(size_t k, const MapKind& kind) const;

  private:
    FrameMetrics again(const FrameMetrics& known, const TileErrors& errors, TileErrors& pool) const;
    void lookAtTruth(const std::shared_ptr<const Truth>& truth);
    void lookAtMethod(const RunningMethod& standIn);
    bool isJudged() const;  // whether the latest frame counts in the pooled figures
    // Where the method's picture or the reference holds a value that is no number: how many, and the displayed picture
    // with the largest difference there. Empty without a reference.
    Rgb farthest(const RunningMethod& method, uint64_t& nonFinite) const;
    void noLinearFigures(FrameMetrics& to) const;
    // A metric of a sequence, and what it keeps of the reference and of every method; null where it cannot be measured.
    struct Watch {
        const Metric* metric;
        std::unique_ptr<SequenceReference> reference;
        std::vector<std::unique_ptr<SequenceTest>> tests;
    };
    void watchReference();
    void watch(size_t k, const Rgb& encoded, const Rgb* linear, FrameMetrics& metrics);
    std::vector<Watch> watches_;
    mutable std::mutex watching_;  // the tests of a metric share its memory
    const Manifest& manifest_;
    const RunOptions& options_;
    bool overTime_;
    std::weak_ptr<const Truth> truth_;             // that reference_ is made of
    std::optional<Reference> reference_, region_;  // region_: the protocol's, where it has one
    const RunningMethod* standIn_ = nullptr;
    std::vector<TileErrors> errors_;
    TemporalScene scene_;
    std::vector<TemporalJudge> overTimeOf_;
    std::optional<ClippedPixels> clipped_;
    double noise_ = 0;
    size_t seen_ = 0, withTruth_ = 0;
    int number_ = 0;
    bool reset_ = false;
};

}  // namespace aa
