// report.html: one file with the figures, charts, pictures and settings of a run; it needs no network to be read.
#pragma once
#include "report/gallery.h"

namespace aa {

// Frames whose pictures are embedded: the last, and up to three more spread over the run.
std::vector<int> framesToShow(const std::vector<int>& withPictures);
// The page. `pictures` are embedded as PNG: whole frames up to 960 x 540, else the part where the methods differ most;
// after about 11 MB of them further frames are left out (the first is always there).
// `angles` is the section of the half-plane study (report/angles.h), empty when there is none.
std::string reportHtml(const RunResults& run, const std::vector<Pictures>& pictures, const std::string& angles = {});
// The same pixels as writePng's, packed as small as PNG can.
std::vector<unsigned char> pngBytes(const Rgb& encoded);
std::string base64(const std::vector<unsigned char>& bytes);

}  // namespace aa
