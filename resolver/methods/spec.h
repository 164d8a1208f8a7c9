// Methods as they are written on the command line, in the panel and in results.json.
#pragma once
#include "methods/method.h"

namespace aa {

struct StageDescriptor;  // methods/stage.h
// A stage as written after a method: `sharpen=norm`.
struct StageSpec {
    const StageDescriptor* stage = nullptr;
    std::string value;
};

// A method as written on the command line, with the stages that run on its output:
// `smaa1x:preset=HIGH,edges=luma`, `uncharted+sharpen=norm`.
struct MethodSpec {
    std::string
        text;  // as written; also the name of its output folder, with characters outside [A-Za-z0-9._=,+-] as '_'
    const MethodDescriptor* method = nullptr;
    std::vector<std::pair<std::string, std::string>> given;
    std::vector<StageSpec> stages;
    std::shared_ptr<const void> owner{};  // of `method`, where it is of no registry
    Params params() const { return Params(method->id, method->params, given, method->writtenAt); }
    PassSet passes() const;
    Space outputSpace() const;       // of the method; stages keep it
    bool readsEncoded() const;       // the method or a method that one of its stages runs
    std::string folderName() const;  // of the text; of a long one its beginning and what tells it apart
    std::unique_ptr<Method> create(const ShotInfo& shot) const;
};
// id[:name=value,...][+stage=value]... Throws UsageError: unknown method or stage, malformed, bad parameter. The spec
// points into `among`.
MethodSpec parseMethod(std::string_view text, const std::vector<MethodDescriptor>& among = registry());
PassSet passesOf(const std::vector<MethodSpec>& methods);
// Of the methods that read frames of this sampling only.
PassSet passesOf(const std::vector<MethodSpec>& methods, Sampling sampling);
// The text without its stages, and with more parameters, written before them: "uncharted:kmin=1+sharpen=norm".
std::string withoutStages(std::string_view text);
std::string withParameters(std::string_view text, std::string_view parameters);

}  // namespace aa
