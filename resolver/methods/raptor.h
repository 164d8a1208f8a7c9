// raptor: the full TAA of seed 002 (Vulkan book ch. 11, "Raptor"), every option of the text; methods/06 s.6.2.
//
//  1. motion of the nearest pixel in 3x3   2. history by Catmull-Rom   3. 3x3 bounds, moments, filtered current colour
//  4. outside: the filtered current colour   5. YCoCg: chroma range from the luma range
//  6. constraint: clamp, clip, variance clip, or clamp then variance clip
//  7. weights 0.1 / 0.9   8. temporal filtering: more history where contrast is high
//  9. luminance of compressed colours c / (1 + max c)   10. luminance difference   11. inverse luminance   12. blend
//  afterwards sharpening by luminance: L' = L + s (L - mean L of 3x3), c L' / L
// `lumaDiff=printed` exchanges the weights as the book's code does (similar colours then ignore history);
// `filterDomain=printed` evaluates the filters at twice the pixel distance (Mitchell and Catmull-Rom then return the
// centre pixel). Both default to the corrected form (methods/11 nr 25, 26); 27-30 list the other corrections.
// Input and output: linear light; depth planar; motion in px, current - previous.
#pragma once
#include "methods/method.h"

namespace aa {
MethodDescriptor raptorDescriptor();
}
