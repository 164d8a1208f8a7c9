// What a reader of one file format gives: image/io.h makes the picture of it.
#pragma once
#include "image/plane.h"

namespace aa {

struct StoredPicture {
    Rgb rgb;            // codes / max, or linear light; not multiplied by alpha
    PlaneF alpha = {};  // empty: none
    bool isFloat = false;
    int orientation = 1;  // as EXIF counts: 1 upright, 6 to be turned right
};

}  // namespace aa
