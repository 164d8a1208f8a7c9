// Frames with every pass at once, drawn from a function of place: for what no analytic scene has, such as chance,
// extremes and one chosen value per pixel. Truth they have none. Units and signs are those of frame.h.
#pragma once
#include <functional>
#include <glm/vec3.hpp>

#include "image/split_mix64.h"
#include "shot/frame.h"

namespace aa {

// What lies at a continuous position of the un-jittered picture.
struct Surface {
    glm::vec3 color;  // linear
    float depthView;
    glm::vec3 normalWorld;
    uint32_t objectId;
};
using DrawnScene = std::function<Surface(double x, double y)>;

// Its view space has x right and y up, looks along -z from 0.1 to 100, and has so many units in a pixel.
Camera orthographicCamera(int width, int height, double unitsPerPixel);

// Sampled at the pixels' centres plus the jitter, and at `subSamplesPx` from there. Every pixel has the same motion;
// edge distances are 0.5 everywhere, and the segments are a star that crosses the picture. Frame 1 resets.
Frame drawFrame(const DrawnScene& scene, int width, int height, int number, glm::dvec2 jitterPx, glm::dvec2 motionPx,
                const std::vector<glm::dvec2>& subSamplesPx);

float logUniform(SplitMix64& g, double least, double most);

// What `draw` makes of the numbers that belong to a sixteenth of a pixel; sub-samples differ.
using SurfaceDraw = std::function<Surface(SplitMix64& g)>;
DrawnScene drawnByChance(unsigned seed, const SurfaceDraw& draw);
// A surface of this colour and depth that faces somewhere; from 1e9 on it is background.
Surface surfaceByChance(SplitMix64& g, glm::vec3 color, float depthView);
// Channels log-uniform between two values, depth from 1 to 10, a fifth background.
SurfaceDraw lightByChance(double least, double most);
// Motion of any direction, its length log-uniform, px.
glm::vec2 motionByChance(SplitMix64& g, double least, double most);
// drawFrame() with chance in every plane: `motionPx` and edge distances differ from pixel to pixel. Light above what
// methods take ends there, as a reader would hand it on (image/input_policy.h).
Frame drawFrameByChance(unsigned seed, const SurfaceDraw& draw, const std::function<glm::vec2(SplitMix64&)>& motionPx,
                        int width, int height, int number, glm::dvec2 jitterPx,
                        const std::vector<glm::dvec2>& subSamplesPx);

}  // namespace aa
