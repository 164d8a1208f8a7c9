// Half-planes at many angles: what a method gains over no anti-aliasing by the direction of an edge.
//
// Every picture is one straight edge (synth scene half_plane) at one of the angles and one of several sub-pixel
// offsets; the truth is the exact area. Methods that accumulate see a period of jittered frames and are judged at the
// last. Squared errors of display-encoded values are pooled over the offsets and the middle half of the picture, so
// that no search ends at the border. Angles and offsets come in mirrored pairs: where the gains at mirrored or turned
// angles differ, the method itself is not symmetric.
#pragma once
#include <string>
#include <vector>

#include "methods/method.h"
#include "methods/spec.h"

namespace aa {

struct AngleStudyOptions {
    std::vector<MethodSpec> methods;
    int angles = 64;   // of the edge's normal, (k + 1/2) * 360 / angles degrees; a multiple of 4
    int offsets = 8;   // (j + 1/2) / offsets - 1/2 px
    int sizePx = 128;  // width and height of a picture
    std::string jitter = "halton23";
    int frames = 16;
};
struct AngleResult {
    std::string text, title, family;
    std::string subsamples;   // pattern that the method was given; empty: none
    std::vector<double> mse;  // by angle
};
struct AngleStudy {
    int offsets = 0, sizePx = 0, frames = 0;
    std::string jitter;
    std::vector<double> degrees;
    std::vector<double> noaaMse;  // by angle
    std::vector<AngleResult> methods;

    double gainDb(size_t method, size_t angle) const;
    double pooledGainDb(size_t method) const;  // of the mean squared errors over all angles
    // Largest difference of the gain between an angle and its mirror image, and between it and a quarter turn, dB.
    double mirrorAsymmetryDb(size_t method) const;
    double turnAsymmetryDb(size_t method) const;
};
// Throws UsageError (angles not a multiple of 4), and what creating a method throws when no sub-sample pattern serves
// it.
AngleStudy studyAngles(const AngleStudyOptions& options, const Exec& exec);

}  // namespace aa
