#include "methods/geometry/msaa.h"

#include "gpu/forms.h"
#include "gpu/forms/geometry/geometry_form.h"
#include "methods/geometry/msaa_slots.h"

namespace aa::gpu {
namespace {

class MsaaForm : public GeometryForm {
  public:
    MsaaForm(Session& session, const Params& p, const ShotInfo& shot, const std::string& id,
             const CoverageSlots& coverage)
        : GeometryForm(session, p, id + ":key=surface", surfaceNeeds(p)),
          samples_(int(shot.subSamplePositionsPx.size())),
          encoded_(averagedSpace(p) == Space::encoded),
          taps_(coverage.taps) {
        const auto ofShot = [&](int k) { return coverage.slotsFirst[size_t(k)]; };
        slots_.resize(size_t(samples_));
        size_t found = 0;
        uint32_t mask = 0;
        for (const int k : coverage.order)
            if (k < coverage.slots) slots_[found++].byDistance = ofShot(k), mask |= 1u << ofShot(k);
        for (int k = 0; k < samples_; k++) slots_[size_t(ofShot(k))].nearest = ofShot(coverage.nearestSlot[size_t(k)]);
        for (ResolveTap& tap : taps_) tap.sample = ofShot(tap.sample);
        group_ = Shader("geometry/msaa", constants(shot, {{10, coverage.slots},
                                                          {11, int(mask)},
                                                          {12, p.choice("key") == "surface"},
                                                          {13, p.choice("shadingPosition") == "centroid"},
                                                          {14, encoded_},
                                                          {15, p.choice("resolve") == "inverseLuminance"},
                                                          {16, filtered()}}));
        if (filtered()) filter_ = Shader("reference/resolve", {{10, false}, {11, encoded_}});
    }

  private:
    struct Slot {
        int32_t byDistance = 0, nearest = 0;
    };
    struct FilterPush {
        int32_t width, height, samples, taps;
        float luminanceScale;
    };
    bool filtered() const { return !taps_.empty(); }
    void record(Current& current, Image& out) override {
        Recorder& recorder = current.recorder();
        recorder.upload(fitted(slotBuffer_, bytesOf(slots_).size()), bytesOf(slots_));
        Image& surfaceColours = filtered() ? fitted(surfaceColours_, current.width(), current.height(),
                                                    session().colour(), std::max(2, samples_))
                                           : unread(Format::r32f, 1);
        const Image& kept = current[encoded_ ? Input::encoded : Input::colour];
        recorder.dispatch(group_, current.width(), current.height(),
                          bindings(current, out, {read(kept), memory(slotBuffer_), written(surfaceColours)}),
                          push(current.frame()));
        if (!filtered()) return;
        recorder.upload(fitted(tapBuffer_, bytesOf(taps_).size()), bytesOf(taps_));
        const Binding filtering[] = {read(surfaceColours), written(out), memory(tapBuffer_)};
        recorder.dispatch(filter_, current.width(), current.height(), filtering,
                          FilterPush{current.width(), current.height(), samples_, int32_t(taps_.size()), 1});
    }

    int samples_;
    bool encoded_;
    std::vector<ResolveTap> taps_;
    std::vector<Slot> slots_;
    Shader group_, filter_;
    Buffer slotBuffer_, tapBuffer_;
    Image surfaceColours_;  // one layer per sub-sample
};

std::unique_ptr<GpuMethod> msaa(Session& s, const Params& p, const ShotInfo& shot) {
    return std::make_unique<MsaaForm>(s, p, shot, "msaa", msaaSlots(p, shot.subSamplePositionsPx));
}
std::unique_ptr<GpuMethod> csaa(Session& s, const Params& p, const ShotInfo& shot) {
    return std::make_unique<MsaaForm>(s, p, shot, "csaa", csaaSlots(p, shot.subSamplePositionsPx));
}
}  // namespace

std::vector<Form> msaaForms() { return {{"msaa", msaa}, {"csaa", csaa}}; }

}  // namespace aa::gpu
