// Every method's GPU form. A new form = one file in gpu/forms/ and one line in forms.cpp.
#pragma once
#include "gpu/method.h"

namespace aa::gpu {

struct Form {
    std::string_view id;  // of the method
    std::unique_ptr<GpuMethod> (*create)(Session& session, const Params& params, const ShotInfo& shot);
};
const Form* findForm(std::string_view id);  // null: none

// In gpu/forms/, each of the methods that one file serves.
std::vector<Form> karisForms();
std::vector<Form> unchartedForms();
std::vector<Form> masterForms();
std::vector<Form> insideForms();
std::vector<Form> raptorForms();
std::vector<Form> fsr2nForms();
std::vector<Form> accumRejectForms();
std::vector<Form> asaaForms();
std::vector<Form> t2msaaForms();
std::vector<Form> smaaMultiForms();
std::vector<Form> fxaaForms();
std::vector<Form> edgeBlurForms();
std::vector<Form> deaaForms();
std::vector<Form> mlaaForms();
std::vector<Form> smaaForms();
std::vector<Form> cmaa2Forms();
std::vector<Form> msaaForms();
std::vector<Form> dmsaaForms();
std::vector<Form> edgeDistanceForms();
std::vector<Form> sraaForms();
std::vector<Form> sbaaForms();
std::vector<Form> rsaaForms();
std::vector<Form> averagesForms();
std::vector<Form> resolveFiltersForms();

}  // namespace aa::gpu
