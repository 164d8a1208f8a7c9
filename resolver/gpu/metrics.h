// Metrics of two pictures on the device, by the shaders of shaders/metrics: the figures of metrics/metrics.h and
// metrics/flip.h, which they agree with to 1e-5.
//
// Every workgroup leaves the sum over its pixels, added in float in a fixed order; these sums are added here in double,
// in order. So a figure does not depend on how the device schedules its work.
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "gpu/method.h"
#include "metrics/metrics.h"

namespace aa::gpu {

class Metrics {
  public:
    struct Figure {
        double mean = 0;
        PlaneF map;  // per pixel, border filled; empty where maps were not asked for
    };
    struct Result {
        SquaredError squares;
        std::map<std::string, Figure, std::less<>> others;
        std::optional<double> deviceSeconds;  // of all dispatches; none where the device has no clock
    };
    // Whether there is a shader for this figure of metrics/metric.h: ssimLuma, ssimRgb, ssimMatlab3D, flip. Squared
    // error is always measured.
    static bool measures(std::string_view figure);

    Metrics(Session& session, int width, int height);
    int width() const { return width_; }
    int height() const { return height_; }
    // Of encoded pictures of this size; `figures` are such that measures() them.
    Result measure(const Rgb& test, const Rgb& reference, const std::set<std::string_view>& figures,
                   bool keepMaps = false);

  private:
    // A shader, its map and the sums of its workgroups.
    struct Pass {
        Shader shader;
        int groupWidth, groupHeight;
        Image map;
        Buffer sums;
    };
    // What the first pass of FLIP leaves of a picture.
    struct AlongX {
        Image contrast, features;
    };
    int groupsAcross(int groupWidth) const { return (width_ + groupWidth - 1) / groupWidth; }
    int groupsDown(int groupHeight) const { return (height_ + groupHeight - 1) / groupHeight; }
    Pass makePass(std::string_view shader, std::vector<Constant> constants, int groupWidth, int groupHeight,
                  int sumsPerGroup, bool hasMap);
    Pass& passOf(std::string_view figure);
    void dispatch(Shader& shader, int groupWidth, int groupHeight, std::span<const Binding> bindings);
    const AlongX& filteredAlongX(const Image& picture, AlongX& to);

    Session& session_;
    int width_, height_;
    Recorder recorder_;
    Image test_, reference_;
    Pass squaredError_;
    std::map<std::string, Pass, std::less<>> others_;  // made when first asked for
    Shader flipAlongX_;
    AlongX testAlongX_, referenceAlongX_;
};

}  // namespace aa::gpu
