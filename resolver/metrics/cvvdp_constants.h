// What [Mantiuk 2024] calibrated on viewers: parameters of version 0.5.6 of its authors' program
// (cvvdp_parameters.json, MIT licence), and the tables of contrast sensitivity (cvvdp_csf.cpp). Channels, in this
// order: achromatic sustained, red-green, yellow-violet, achromatic transient.
#pragma once

namespace aa::cvvdp_constants {

inline constexpr int kChannels = 4, kStillChannels = 3;  // a still has no transient channel

// Light: linear sRGB -> CIE XYZ -> cone responses (2006) -> opponent colours about D65.
constexpr double kRgbToXyz[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
constexpr double kXyzToLms[3][3] = {{0.187596268556126, 0.585168649077728, -0.026384263306304},
                                    {-0.133397430663221, 0.405505777260049, 0.034502127690364},
                                    {0.000244379021663, -0.000542995890619, 0.019406849066323}};
constexpr double kLmsToDkl[3][3] = {{1, 1, 0}, {1, -2.311130179947035, 0}, {-1, -1, 50.977571328718781}};
inline constexpr double kLeastLight = 0.005;  // of a display that is fed linear light, cd/m2

// Temporal filters, in frequency (Hz): exp(-f^beta / sigma) of the sustained channels,
// exp(-(f^beta - 5^beta)^2 / sigma) of the transient one; a quarter of a second long.
constexpr double kTemporalSigma[kChannels] = {5.79336, 14.1255, 6.63661, 0.12314};
constexpr double kTemporalBeta[kChannels] = {1.3314, 1.1196, 0.947901, 0.1898};
inline constexpr double kTransientPeakHz = 5, kFilterSeconds = 0.25;

// Pyramid: least frequency of a band and the peak of band i > 0, 0.3228 x 2^(1 - i) of the Nyquist frequency.
inline constexpr double kLeastFrequency = 0.2, kBandPeak = 0.3228, kBasebandFrequency = 0.1;  // cycles per degree
inline constexpr double kLeastBackground = 0.01, kMostContrast = 1000;

// Contrast sensitivity.
inline constexpr int kCsfSize = 32;
extern const float kLogSensitivity[kChannels][kCsfSize][kCsfSize];
constexpr double kCsfLuminance[2] = {0.005, 10000}, kCsfFrequency[2] = {0.1, 64};
inline constexpr double kCsfFirstLog2 = -7.643856189774724;                                        // of 0.005
inline constexpr double kCsfStepsPerLog2 = (kCsfSize - 1) / (13.287712379549449 - kCsfFirstLog2);  // and of 10,000
inline constexpr double kSensitivityCorrectionDb = -0.2797423303127289;

// Masking.
constexpr double kGain[kChannels] = {1, 1.45, 1, 1};
inline constexpr double kMaskP = 2.264355182647705, kMaskGain = 0.16014112700938743;  // 10^-0.7955
constexpr double kMaskQ[kChannels] = {1.302622675895691, 2.8885908126831055, 3.6807713508605957, 3.588787317276001};
// log2 of how much channel [row] masks channel [column].
constexpr double kCrossMasking[kChannels][kChannels] = {
    {-0.18950104713439941, -5.962151050567627, -4.31834602355957, -1.9321587085723877},
    {2.5655593872070312, 0.34406712651252747, -2.719646453857422, -0.4970424771308899},
    {3.8118371963500977, -1.0051705837249756, -0.5193376541137695, -0.5653647780418396},
    {-7.054771423339844, -5.527150630950928, -3.5106418132781982, -2.08804988861084}};
inline constexpr double kMostDifference = 366.6447430102025;  // 10^2.5642; differences saturate there
// Blur for the phase uncertainty, px of the band: exp(-i^2 / 18) over the sum of all thirteen.
inline constexpr int kBlurReach = 6;
constexpr double kBlur[kBlurReach + 1] = {0.13702281648422546, 0.1296180307095271,   0.1097192942119251,
                                          0.08310853927786037, 0.056331763936575935, 0.03416694194322773,
                                          0.018544021678771058};
// x^p is taken as (x + e)^p - e^p everywhere. e^q, e^p and e^(1/4):
inline constexpr double kEpsilon = 1e-5;
constexpr double kEpsilonQ[kChannels] = {3.0682208759891406e-07, 3.6061678448558755e-15, 3.945874295190332e-19,
                                         1.1377934088908656e-18};
inline constexpr double kEpsilonP = 4.766768785436755e-12, kEpsilonFourthRoot = 0.05623413251903491;

// Pooling.
constexpr double kChannelWeight[kChannels] = {1, 1, 1, 0.8081134557723999};
constexpr double kBasebandWeight[kChannels] = {0.0036334486212581396, 1.6627724170684814, 4.11874532699585,
                                               25.25969886779785};
inline constexpr double kBandExponent = 4, kChannelExponent = 4;  // over pixels and frames it is 2
inline constexpr double kStillWeight = 0.577918291091919;
inline constexpr double kJodScale = 0.0439569391310215, kJodExponent = 0.9302042722702026, kJodLinearBelow = 0.1;

}  // namespace aa::cvvdp_constants
