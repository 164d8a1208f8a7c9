// Stages: what runs on a method's output, in the method's output space, and is never fed back into its history.
//
// Written after the method: `uncharted+sharpen=norm`, several in order. A stage's value is one ParamSpec (choice,
// number or flag), or the specification of a method that the stage runs beside the first one
// (`asaa+fill=fxaa311:preset=39`). A new stage = one StageDescriptor in stage.cpp; it then appears in `list` and is
// open to every method.
#pragma once
#include "methods/spec.h"

namespace aa {

class Stage {
  public:
    virtual ~Stage() = default;
    // Changes `image`, the output of `method` for `frame`. Its border is filled on entry and need not be on return.
    virtual void apply(const Frame& frame, const Method& method, Space space, const Exec& exec, Rgb& image) = 0;
    virtual bool needsRejection() const { return false; }  // whether apply() reads method.rejection()
    virtual size_t stateBytes() const { return 0; }
};

struct StageDescriptor {
    ParamSpec value;  // name of the stage, allowed values, help and source; defaultValue is unused
    PassSet passes = {};
    bool valueIsMethod = false;  // the value is a method's specification; `value` only carries name, help and source
    // `value` as checked. Throws UsageError/InputError when method or shot cannot serve the stage.
    std::function<std::unique_ptr<Stage>(const std::string& value, const MethodSpec& spec, const ShotInfo& shot)>
        create;
};
const std::vector<StageDescriptor>& stages();
const StageDescriptor& findStage(std::string_view name);  // throws UsageError with a suggestion

// Throws UsageError: unknown stage, no or bad value.
StageSpec parseStage(std::string_view text);
PassSet passesOf(const StageSpec& stage);
bool readsEncoded(const StageSpec& stage);

// `method` followed by the stages of its specification.
std::unique_ptr<Method> withStages(std::unique_ptr<Method> method, const MethodSpec& spec, const ShotInfo& shot);

}  // namespace aa
