// The frames on which stability is measured. All are encoded for the display without exposure.
#pragma once
#include <vector>

#include "methods/driver.h"

namespace aa::stability {

// Light from 1e-6 to 1e6, log-uniform by chance in every channel, motion of 0.1 to 3 px: the torture set's.
inline constexpr int kWideLightWidth = 33, kWideLightHeight = 19, kWideLightFrames = 4;
inline constexpr unsigned kWideLightSeeds = 12;  // from 1; a decision that float takes otherwise is rare
std::vector<Frame> wideLightFrames(unsigned seed, const std::vector<glm::dvec2>& subSamplesPx);

// What the pictures at rest below say of themselves.
ShotInfo restingInfo(const Frame& frame);

// Pictures at rest whose every second pixel of every second row is looked at: those beside it have code 230 of 255,
// those above and below 26, and the others 128. A neighbourhood's box is wide and its mean nearly the pixel's own
// value, so that neither a clip nor sharpening hides what the history holds.
inline constexpr int kEvery = 2;
// All of one code.
inline constexpr double kStallFrom = 128, kStallTo = 136;
inline constexpr int kStallWidth = 32, kStallHeight = 16;
Frame stallFrame(int number, double code, const std::vector<glm::dvec2>& subSamplesPx);
// From one to the next 0.025 codes more to the right and 0.012 downward, from 128: steps as wide as they band.
inline constexpr int kGradientWidth = 128, kGradientHeight = 80, kGradientFrames = 32;
Frame gradientFrame(int number, const std::vector<glm::dvec2>& subSamplesPx);
// Those pixels alone, as a picture.
Rgb lookedAt(const Rgb& image);

// Shapes at rest, jittered by Halton(2, 3) with a period of kRestPeriod.
inline constexpr int kRestWidth = 48, kRestHeight = 32, kRestPeriod = 16;
inline constexpr float kFirefly = 1e6f;
Frame restingFrame(int number, const std::vector<glm::dvec2>& subSamplesPx);
void addFireflies(Frame& frame);  // of kFirefly, one pixel in every 8x8

// Every colour as a render of few samples has it: 2 % of grain, new in every frame.
void addGrain(Frame& frame, uint32_t seed);

// Copies with small changes, signs by chance; `draw` 2k + 1 has the opposite signs of 2k. Colours moved by one unit in
// the last place; and all that a method reads as a number (colours, depth, motion, normals, edge distances) by `share`
// of itself, but for values that stand for "nothing" (background, no motion).
Frame movedByOneUlp(const Frame& frame, uint32_t seed);
Frame movedByShare(const Frame& frame, double share, uint32_t seed, int draw);

}  // namespace aa::stability
