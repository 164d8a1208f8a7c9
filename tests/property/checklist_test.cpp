// What a method's descriptor must say and its class must do, beside giving good pixels. Each message names the file to
// touch; CONTRIBUTING.md walks through them. What lies in other files (registry, docs): tests/e2e/checklist_test.py.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

#include "frames.h"

namespace aa::testing {
namespace {

// One sentence per fault of the descriptor, the file first.
std::vector<std::string> faultsOf(const MethodDescriptor& m) {
    std::vector<std::string> faults;
    const auto check = [&](bool good, const std::string& what) {
        if (!good) faults.push_back(m.writtenAt.text() + ": method '" + std::string(m.id) + "': " + what);
    };
    check(!m.id.empty() && std::all_of(m.id.begin(), m.id.end(), [](unsigned char c) { return std::isalnum(c); }),
          ".id: letters and digits only");
    check(std::set<std::string_view>{"reference", "spatial", "geometry", "temporal"}.contains(m.family),
          ".family: expected reference, spatial, geometry or temporal, found '" + std::string(m.family) + "'");
    check(!m.title.empty(), ".title is missing: the head of its column");
    check(m.summary.ends_with('.'), ".summary: one sentence with its full stop");
    check(!m.source.empty(), ".source is missing: a key of docs/sources.md, or what it is");
    check(!m.passes.empty(), ".passes is missing: what it reads of a frame");
    check(bool(m.create), ".create is missing");
    check(m.family != "spatial" || m.reachPx > 0 || m.reachPx == kAnyReachPx,
          ".reachPx is missing: the largest distance in px at which a pixel may influence another, or kAnyReachPx");
    for (const auto& p : m.params) {
        const std::string parameter = ".params, '" + std::string(p.name) + "': ";
        check(!p.help.empty(), parameter + "help is missing: one line with the unit");
        check(!p.source.empty(), parameter + "source is missing: where the default comes from");
    }
    return faults;
}
// And of what it does with one frame: parameters that its table lacks, debug layers.
std::vector<std::string> faultsOfRunning(const MethodDescriptor& m) {
    const std::string head = m.writtenAt.text() + ": method '" + std::string(m.id) + "': ";
    const std::vector<MethodDescriptor> alone = {m};  // a running method points into it
    const auto layers = [&](bool keep) {
        Subject s = makeSubject(std::string(m.id), 40, 24, alone);
        s.running.method->keepDebugLayers = keep;
        for (int n = 1; n <= 2; n++) step(s, renderFrame(shapes(), 40, 24, n, halton(n), {1, 0}, s.samples));
        return s.running.method->debugLayers();
    };
    try {
        std::vector<std::string> faults;
        const std::vector<DebugLayer> kept = layers(true);
        if (m.family != "reference" && kept.empty())
            faults.push_back(head +
                             "debugLayers() is empty with keepDebugLayers; return at least one intermediate image "
                             "(resolver/methods/method.h; resolver/methods/spatial/skeleton.cpp shows how)");
        for (const auto& layer : kept)
            for (const auto& plane : layer.planes)
                if (plane.width() != 40 || plane.height() != 24)
                    faults.push_back(head + "debug layer '" + layer.name + "' has not the size of the frame");
        if (!layers(false).empty()) faults.push_back(head + "debugLayers() is not empty without keepDebugLayers");
        return faults;
    } catch (const std::logic_error& e) {  // names the file by itself
        return {e.what()};
    }
}
std::string lines(const std::vector<std::string>& faults) {
    std::string all;
    for (const auto& f : faults) all += "\n" + f;
    return all;
}

TEST(Checklist, DescriptorsAreComplete) {
    std::set<std::string_view> ids;
    for (const auto& m : methodsUnderTest()) {
        EXPECT_EQ(lines(faultsOf(m)), "");
        EXPECT_TRUE(ids.insert(m.id).second) << m.writtenAt.text() << ": .id '" << m.id << "' is taken";
    }
}
TEST(Checklist, MethodsKeepTheRules) {
    for (const auto& m : methodsUnderTest()) EXPECT_EQ(lines(faultsOfRunning(m)), "");
}

// ---- each rule is able to fail --------------------------------------------------------------------------------------
template <class Change>
std::string faultsWith(const Change& change) {
    MethodDescriptor m = spatialSkeletonDescriptor();
    change(m);
    const std::string found = lines(faultsOf(m));
    return found.empty() ? lines(faultsOfRunning(m)) : found;
}
class Silent : public Method {
  public:
    explicit Silent(bool layers = false) : layers_(layers) {}
    void resolve(const Frame& frame, const Exec&, Rgb& out) override { out = frame.colorEncoded; }
    std::vector<DebugLayer> debugLayers() const override {
        return layers_ ? std::vector<DebugLayer>{{"edge", {PlaneF(40, 24)}}} : std::vector<DebugLayer>{};
    }

  private:
    bool layers_;
};

TEST(ChecklistNegative, EveryFaultIsNamedWithItsFile) {
    using ::testing::AllOf, ::testing::HasSubstr;
    const std::string file = "resolver/methods/spatial/skeleton.cpp";
    EXPECT_EQ(faultsWith([](auto&) {}), "");
    EXPECT_THAT(faultsWith([](auto& m) { m.reachPx = 0; }), AllOf(HasSubstr(file), HasSubstr(".reachPx is missing")));
    EXPECT_THAT(faultsWith([](auto& m) { m.family = "spacial"; }), AllOf(HasSubstr(file), HasSubstr(".family")));
    EXPECT_THAT(faultsWith([](auto& m) { m.source = ""; }), AllOf(HasSubstr(file), HasSubstr(".source")));
    EXPECT_THAT(faultsWith([](auto& m) { m.summary = "Blurs"; }), AllOf(HasSubstr(file), HasSubstr(".summary")));
    EXPECT_THAT(faultsWith([](auto& m) { m.params[0].help = ""; }), AllOf(HasSubstr(file), HasSubstr("'luma': help")));
    EXPECT_THAT(faultsWith([](auto& m) { m.create = nullptr; }), AllOf(HasSubstr(file), HasSubstr(".create")));
    EXPECT_THAT(faultsWith([](auto& m) {
                    m.create = [](const Params&, const ShotInfo&) { return std::make_unique<Silent>(); };
                }),
                AllOf(HasSubstr(file), HasSubstr("debugLayers() is empty")));
    EXPECT_THAT(faultsWith([](auto& m) {
                    m.create = [](const Params&, const ShotInfo&) { return std::make_unique<Silent>(true); };
                }),
                AllOf(HasSubstr(file), HasSubstr("without keepDebugLayers")));
    EXPECT_THAT(faultsWith([](auto& m) {  // the class reads a parameter that the table has lost
                    std::erase_if(m.params, [](const auto& p) { return p.name == "strength"; });
                }),
                AllOf(HasSubstr(file), HasSubstr("spatialSkeleton"), HasSubstr("'strength'")));
}

}  // namespace
}  // namespace aa::testing
