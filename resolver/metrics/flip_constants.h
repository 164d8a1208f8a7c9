// Filters and constants of LDR-FLIP at 67.02 pixels per degree, centre tap first ([Andersson 2020]; flip_test.cpp
// computes each of them again from its formula). Literals, not calls of exp: libm differs between machines.
#pragma once

namespace aa::flip_constants {

// Contrast sensitivity, exp(-pi^2 (i / ppd)^2 / b), each row normalised to sum 1. The radius is ceil(3 sqrt(0.04 / (2
// pi^2)) ppd) = 10; taps of the two narrow filters beyond 6 weigh less than 2e-9 and are left out.
constexpr int kCsfReach = 10, kNarrowReach = 6;
constexpr double kCsfY[] = {0.3857601970112706,     0.24170370117189147,  0.05945398352916367,  0.00574130194862394,
                            0.00021765647401644577, 3.23939988646555e-06, 1.892732797365621e-08};  // b = 0.0047
constexpr double kCsfCx[] = {0.36326905951403626,   0.23998234320944672,    0.0691881836292993,  0.008705351854194373,
                             0.0004780160610678259, 1.1455140190354442e-05, 1.19800902044881e-07};  // b = 0.0053
constexpr double kCsfCzWide[] = {0.13229436880465997,  0.12522321511963477,  0.10619775230847892,
                                 0.08069242790945257,  0.054933494154912915, 0.03350646786375918,
                                 0.01831078890689446,  0.008965457304642323, 0.0039330079168640245,
                                 0.001545838707416537, 0.0005443654056143405};  // b = 0.04
constexpr double kCsfCzNarrow[] = {0.16726318256374276,    0.15318983292982022,   0.1176843470763084,
                                   0.07583446634438805,    0.04098960571499363,   0.018584035215752425,
                                   0.007067494380143849,   0.002254499259481186,  0.0006032452282470633,
                                   0.00013539320429836009, 2.5489364695425175e-05};  // b = 0.025
// Cz mixes two Gaussians a sqrt(pi / b) exp(...) in two dimensions, a = 34.1 and 13.5: the share of the wide one.
constexpr double kCzWideShare = 0.7614569612435086;
// Along x they are added up, each by its share.
struct CzTaps {
    double of[kCsfReach + 1];
};
constexpr CzTaps shareOf(const double (&taps)[kCsfReach + 1], double share) {
    CzTaps r{};
    for (int i = 0; i <= kCsfReach; i++) r.of[i] = taps[i] * share;
    return r;
}
constexpr CzTaps kCzWideAlongX = shareOf(kCsfCzWide, kCzWideShare),
                 kCzNarrowAlongX = shareOf(kCsfCzNarrow, 1 - kCzWideShare);

// Features: G, -x G and (x^2 / sd^2 - 1) G with sd = 0.5 * 0.082 ppd and radius ceil(3 sd) = 9. G sums to 1; of the
// other two the positive and the negative weights sum to +1 and -1. kEdge holds the taps at +i, which count negative.
constexpr int kFeatureReach = 9;
constexpr double kGauss[] = {0.14525746640444767,  0.13595016961715498,  0.11145604302398379,  0.08004055011296823,
                             0.050349955035247564, 0.027744102929369515, 0.013391365532051176, 0.0056618925119628575,
                             0.002096915613967445, 0.0006802724210706329};  // G
constexpr double kEdge[] = {0.0,
                            0.1256490277906996,
                            0.2060217134969253,
                            0.22192728410376722,
                            0.1861394632253844,
                            0.1282094597534248,
                            0.07426009388427243,
                            0.03663017884500408,
                            0.015504234176161005,
                            0.005658544724361138};  // |-x G|
constexpr double kPoint[] = {-0.29890154339811237, -0.24269989461365843, -0.10784933368728536, 0.03205402824041916,
                             0.11755038888686649,  0.13376789122035074,  0.10526869671677357,  0.06484573606181976,
                             0.032707097503376956, 0.01380616137039334};  // (x^2 / sd^2 - 1) G

// Linear BT.709 -> XYZ over the white point (row sums of the reference implementation's matrix), and back.
constexpr double kToXyz[3][3] = {{0.4338953888315031, 0.37624237262225113, 0.1898622385462458},
                                 {0.21263682167732384, 0.7151829818412507, 0.07218019648142547},
                                 {0.01775242315172993, 0.10946562866246513, 0.872781948185805}};
constexpr double kToRgb[3][3] = {{3.0803419882804612, -1.5373989694887855, -0.5429430187916752},
                                 {-0.9211783961651236, 1.875929983695176, 0.045248412469947596},
                                 {0.05288129287554323, -0.20401120612390997, 1.1511299132483668}};

// Luminance, red-green and blue-yellow of linear BT.709: (Y, 500 (X - Y), 200 (Y - Z)) of the above, and back. The
// paper's offset and scale of the first, 116 Y - 16, pass through every normalised filter and are left out here.
struct Matrix {
    double m[3][3];
};
constexpr Matrix kToOpponent = [] {
    Matrix r{};
    for (int i = 0; i < 3; i++) {
        r.m[0][i] = kToXyz[1][i];
        r.m[1][i] = 500 * (kToXyz[0][i] - kToXyz[1][i]);
        r.m[2][i] = 200 * (kToXyz[1][i] - kToXyz[2][i]);
    }
    return r;
}();
constexpr Matrix kOpponentToRgb = [] {
    Matrix r{};
    for (int i = 0; i < 3; i++) {
        r.m[i][0] = kToRgb[i][0] + kToRgb[i][1] + kToRgb[i][2];
        r.m[i][1] = kToRgb[i][0] / 500, r.m[i][2] = -kToRgb[i][2] / 200;
    }
    return r;
}();

// HyAB distance between green and blue after the Hunt adjustment, to the power 0.7.
constexpr double kMaxColour = 41.276098414595445;

}  // namespace aa::flip_constants
