#include "methods/geometry/sraa.h"

#include "gpu/forms.h"
#include "gpu/forms/geometry/geometry_form.h"

namespace aa::gpu {
namespace {

class SraaForm : public OneShaderGeometryForm {
  public:
    SraaForm(Session& session, const Params& p, const ShotInfo& shot, const SraaArgs& a)
        : OneShaderGeometryForm(session, p, "sraa:distance=plane", sraaNeeds(a),
                                Shader("geometry/sraa", constants(shot, {{10, a.radius},
                                                                         {11, a.maxMetric},
                                                                         {12, a.plainDepth},
                                                                         {13, a.ids},
                                                                         {14, a.spatial},
                                                                         {15, a.depth},
                                                                         {16, a.normal},
                                                                         {17, a.sharpness},
                                                                         {18, a.depthSigma}}))) {}
};
}  // namespace

std::vector<Form> sraaForms() {
    return {{"sraa", [](Session& s, const Params& p, const ShotInfo& shot) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<SraaForm>(s, p, shot, sraaArgs(p));
             }}};
}

}  // namespace aa::gpu
