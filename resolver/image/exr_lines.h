// Pixels of an EXR part that was packed with ZIP or ZIPS, unpacked by image/exr_zip.h on all threads: OpenEXR's own
// reader takes four times as long, and moves every value several times.
#pragma once
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputPart.h>

namespace aa {

// Whether a part is one of lines and ZIP whose channels all have a value for each pixel.
bool hasZipLines(const Imf::Header& header);
// Fills the slices, which are of float or of whole numbers, as dense as the pixels, and of channels that the part has;
// float takes half, too. False where the part is damaged or incomplete: OpenEXR's reader says in which way.
bool readZipLines(Imf::InputPart& part, const Imf::FrameBuffer& slices);

}  // namespace aa
