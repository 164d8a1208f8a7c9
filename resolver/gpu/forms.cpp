#include "gpu/forms.h"

namespace aa::gpu {
namespace {
std::vector<Form> allForms() {
    std::vector<Form> all;
    for (const auto& family :
         {karisForms(), unchartedForms(),   masterForms(),   insideForms(),        raptorForms(),
          fsr2nForms(), accumRejectForms(), asaaForms(),     t2msaaForms(),        smaaMultiForms(),
          fxaaForms(),  edgeBlurForms(),    deaaForms(),     mlaaForms(),          smaaForms(),
          cmaa2Forms(), msaaForms(),        dmsaaForms(),    edgeDistanceForms(),  sraaForms(),
          sbaaForms(),  rsaaForms(),        averagesForms(), resolveFiltersForms()})
        all.insert(all.end(), family.begin(), family.end());
    return all;
}
}  // namespace

const Form* findForm(std::string_view id) {
    static const std::vector<Form> all = allForms();
    for (const Form& form : all)
        if (form.id == id) return &form;
    return nullptr;
}

}  // namespace aa::gpu
