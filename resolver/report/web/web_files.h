// The files of this folder and the inlined npm packages, embedded by CMakeLists.txt.
#pragma once
#include <string_view>

namespace aa::web {
extern const std::string_view html, css, js, chart, common, tables, angles, stability;
// The viewer's, in the order in which they build on each other.
extern const std::string_view viewerCss, viewerCodec, viewerPictures, viewerMeasure, viewerFlip, viewerPaint,
    viewerState, viewerStage, viewerInput, viewerFigures, viewerControls, viewerCrops, viewerMain;
extern const std::string_view surveyHtml, surveyCss, surveyJs;  // the survey's page
extern const std::string_view scoresHtml, scoresJs;             // and that of its scores
extern const std::string_view head;                             // of every page
extern const std::string_view sweepHtml, sweepJs;               // the page of a sweep
extern const std::string_view summaryHtml, summaryJs;           // of several runs
}  // namespace aa::web
