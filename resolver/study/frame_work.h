// What a run does with one frame: every method resolves it, is judged and leaves its picture. Methods work side by
// side, as many as there are threads; what they hold of a frame is given back as soon as nobody reads it.
#pragma once
#include <memory>
#include <vector>

#include "study/feed.h"
#include "study/judge.h"
#include "study/prepare.h"
#include "study/run.h"

namespace aa {

class FrameWork {
  public:
    FrameWork(const ShotReader& shot, const RunOptions& options, const InputPlan& plan, Judge& judge,
              std::vector<RunningMethod>& methods, RunResults& results);
    // Frame `i` of the run. Of the item, what nobody reads any more is given back.
    void operator()(Feed::Item& item, size_t i);

  private:
    bool isWritten(size_t i) const;
    bool readsSubSamples(size_t k) const { return passes_[k].hasAnyOf(Pass::subsamples | Pass::subsampleColor); }
    bool readsCentre(size_t k) const { return plan_.readsCentre(methods_[k].spec); }
    // The methods but the reference: those first that read sub-samples, then others that read pixel centres.
    std::vector<size_t> order() const;
    double secondsBefore(size_t k) const;  // that method k took for the frame before
    void forgetSubSamples(Feed::Item& item, size_t i) const;
    void lookAtTruth(Feed::Item& item, size_t i);
    void work(size_t k, const Feed::Item& item, size_t i);
    ResolveSeconds resolve(size_t k, const Frame& input, const FrameResult* known);
    void writePictures(size_t k, const Frame& frame, bool isReference, FrameResult& result);
    void note(size_t k, const Frame& input, FrameResult result);
    // Of the earlier run that this one goes on with.
    const FrameResult* knownFrame(size_t k, size_t i) const;
    Trace::Span span(std::string_view stage, size_t k) const;

    const Manifest& manifest_;
    const RunOptions& options_;
    const InputPlan& plan_;
    Judge& judge_;
    std::vector<RunningMethod>& methods_;
    std::vector<PassSet> passes_;  // that each reads: taken from its parameters once
    RunResults& results_;
    std::vector<std::unique_ptr<Method>> timed_;  // the same methods on a device, for its time alone
    Rgb unused_;                                  // what they make
    std::optional<size_t> reference_;             // the method that the others are held against
};

}  // namespace aa
