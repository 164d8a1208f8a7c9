// What the program and its module aaresolve_formats.so know of each other: C, so that neither needs the other's types.
#pragma once

extern "C" {

struct AaPicture {
    int width, height, channels;
    int isFloat;      // 1: linear light; 0: codes / max
    int alpha;        // its channel; -1: none. Colours are not multiplied by it
    int orientation;  // as EXIF counts: 1 upright
};
// Null when the file is no picture that the module knows.
typedef void* (*AaOpenPicture)(const char* file, AaPicture* picture);
// Puts the first `channels` channels, interleaved, row by row; 0 when the file is truncated or damaged.
typedef int (*AaReadPicture)(void* opened, int channels, float* pixels);
typedef void (*AaClosePicture)(void* opened);
}

// The functions' names; a module of another interface has others.
inline constexpr const char kAaOpenPicture[] = "aaOpenPicture2", kAaReadPicture[] = "aaReadPicture2",
                            kAaClosePicture[] = "aaClosePicture2";
