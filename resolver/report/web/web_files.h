// The files of this folder and the inlined npm packages, embedded by CMakeLists.txt.
#pragma once
#include <string_view>

namespace aa::web {
extern const std::string_view html, css, js, chart, slider, sliderCss, angles;
}
