// Blender's own multilayer EXRs: which channel means what, in every version of the names.
//
// Channels are called LAYER.PASS.C, or LAYER.PASS.VIEW.C in a multi-view render; newer Blenders write other names for
// some passes and may give each pass a part of its own. Units and signs stay Blender's (blender_motion.h turns them).
#pragma once
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "image/exr.h"

namespace aa {

enum class BlenderPass {
    combined,
    depth,
    normal,
    vector,
    objectIndex,
    cryptoObject,
    denoisingAlbedo,
    diffuseColor,
    glossyColor,
    transmissionColor,
    emission,
    environment,
};
struct BlenderPassInfo {
    BlenderPass pass;
    std::vector<std::string_view> names;  // 3.x and 4.x first, then 5.x
    size_t components;                    // that are read: RGB, XYZ, Z
    std::string_view whereToSwitchOn;     // in Blender's View Layer properties
};
const BlenderPassInfo& blenderPass(BlenderPass pass);

// What one channel of a file is.
struct BlenderChannel {
    std::string layer, view;  // view: empty unless multi-view
    BlenderPass pass = BlenderPass::combined;
    char component = 'R';  // upper case
    size_t part = 0;
    std::string channel;  // as the file calls it
};

// One file, opened and understood. Not thread-safe. Errors are InputErrors of one line.
class BlenderExr {
  public:
    explicit BlenderExr(const std::filesystem::path& file);  // missing, damaged

    const std::filesystem::path& path() const { return file_.path(); }
    int width() const { return file_.parts()[0].width; }
    int height() const { return file_.parts()[0].height; }
    const ExrFile& file() const { return file_; }
    // An attribute that is a text: Frame, RenderTime, cycles.LAYER.samples.
    std::optional<std::string> text(const std::string& name) const;
    std::vector<std::string> layers() const;  // with a Combined or Depth pass; the compositor's only when it is alone
    std::vector<std::string> views(const std::string& layer) const;  // {""} unless multi-view

    // Chooses what the functions below read. Throws UsageError naming what there is: several layers or views and no
    // choice, or a choice that is not there.
    void choose(const std::string& layer, const std::string& view);
    const std::string& layer() const { return layer_; }
    const std::string& view() const { return view_; }
    bool has(BlenderPass pass) const;
    const ExrChannel* channelOf(BlenderPass pass, size_t component) const;  // for its stored type

    // Asks for a pass; read() then fills all planes asked for in one go.
    void want(BlenderPass pass, std::vector<std::variant<PlaneF*, PlaneU*>> planes);
    void wantPlain(Rgb& rgb);  // channels R G B of a file without layers
    bool isPlain() const { return channels_.empty() && file_.parts()[0].find("R") != nullptr; }
    void read();

  private:
    const BlenderChannel* find(BlenderPass pass, size_t component) const;
    ExrFile file_;
    std::vector<BlenderChannel> channels_;
    std::string layer_, view_;
    std::vector<std::vector<ChannelTarget>> targets_;  // per part
};

}  // namespace aa
