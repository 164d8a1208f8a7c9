// MLAA: morphological anti-aliasing (Reshetov 2009; methods/03 s.3.1).
//
// 1. Edges between neighbours whose colours differ. 2. Maximal runs of collinear edges are separation lines; edges that
// cross their ends make L, Z and U shapes. 3. The silhouette runs from half the height of the crossing edge at one end
// to the other end (Z) or to the middle of the line (L, U); heights=colour: from where the blended lumas of both sides
// of the crossing edge agree, the middle where nothing decides. 4. Each pixel on the invaded side is blended with the
// pixel across the line by the area that the silhouette cuts off: horizontal lines first, then vertical lines on their
// result, edges always from the original image; simultaneous: vertical lines too on the original, and a pixel that both
// move goes halfway with each. Encoded colour. Deviation: a line is measured in one scan whatever its
// length, so there is no search limit to choose.
#pragma once
#include "methods/method.h"

namespace aa {
MethodDescriptor mlaaDescriptor();
}
