#include "methods/geometry/sbaa.h"

#include "gpu/forms.h"
#include "gpu/forms/geometry/geometry_form.h"

namespace aa::gpu {
namespace {

class SbaaForm : public OneShaderGeometryForm {
  public:
    SbaaForm(Session& session, const Params& p, const ShotInfo& shot)
        : OneShaderGeometryForm(session, p, "sbaa", sbaaNeeds(),
                                Shader("geometry/sbaa", constants(shot, {{10, p.integer("surfaces")},
                                                                         {11, p.realf("mergeNormal")},
                                                                         {12, p.realf("mergeDepth")},
                                                                         {13, p.flag("ids")}}))) {}
};
}  // namespace

std::vector<Form> sbaaForms() {
    return {{"sbaa", [](Session& s, const Params& p, const ShotInfo& shot) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<SbaaForm>(s, p, shot);
             }}};
}

}  // namespace aa::gpu
