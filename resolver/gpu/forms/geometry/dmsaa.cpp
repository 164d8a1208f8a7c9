#include "methods/geometry/dmsaa.h"

#include "gpu/forms.h"
#include "gpu/forms/geometry/geometry_form.h"

namespace aa::gpu {
namespace {

class DmsaaForm : public OneShaderGeometryForm {
  public:
    DmsaaForm(Session& session, const Params& p, const ShotInfo& shot)
        : OneShaderGeometryForm(session, p, "dmsaa", {},
                                Shader("geometry/dmsaa", constants(shot, {{10, int(p.choiceIndex("vecMode"))},
                                                                          {11, p.realf("depthThreshold")},
                                                                          {12, p.realf("gain")}}))) {}
};
}  // namespace

std::vector<Form> dmsaaForms() {
    return {{"dmsaa", [](Session& s, const Params& p, const ShotInfo& shot) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<DmsaaForm>(s, p, shot);
             }}};
}

}  // namespace aa::gpu
