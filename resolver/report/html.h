// report.html: one file with the figures, charts, pictures and settings of a run; it needs no network to be read.
#pragma once
#include "report/viewer_data.h"

namespace aa {

// The page, with the pictures of `viewer`. `sections`: what other commands measured (report/angles.h, stability.h),
// empty when there is none.
std::string reportHtml(const RunResults& run, const ViewerData& viewer, const std::string& sections = {});
// The same pixels as writePng's, packed as small as PNG can.
std::vector<unsigned char> pngBytes(const Rgb& encoded);
std::string base64(const std::vector<unsigned char>& bytes);

}  // namespace aa
