// What the program and its module aaresolve_documents.so know of each other: C, so that neither needs the other's
// types.
#pragma once
#include <cstddef>

extern "C" {

// One thing drawn on a page, in pixels of the page, y down.
struct AaMark {
    enum Kind { isFill, isPicture, isText } kind;
    int x, y;               // top left; of a text the left end of its baseline
    int width, height;      // of the area; of the picture in its own pixels; of a text its advance and its size
    int magnification = 1;  // page's pixels per pixel of a picture
    float colour[3] = {};   // encoded sRGB, [0,1]
    const unsigned char* codes = nullptr;  // of a picture: 8-bit sRGB, R G B R G B ..., row by row
    const char* text = nullptr;            // UTF-8
    int bold = 0;
};
struct AaPage {
    int width, height;  // px
    const AaMark* marks;
    size_t count;
};
struct AaPdf {
    const AaPage* pages;
    size_t count;
    double pointsPerPx;
    const char *title, *regularFont, *boldFont;  // fonts: files
};
// Null when the file was written, else why it was not.
typedef const char* (*AaWritePdf)(const char* file, const AaPdf* pdf);

// Pictures of one size that follow each other for ever; a single one is a still picture.
struct AaLoop {
    int width, height;
    const unsigned char* const* frames;  // codes of each, as above
    size_t count;
    int milliseconds;  // that each is shown
};
typedef const char* (*AaWriteWebp)(const char* file, const AaLoop* loop);  // lossless
// `palette`: `colours` <= 256 times R G B; the frames are then indices into it, one byte per pixel.
typedef const char* (*AaWriteGif)(const char* file, const AaLoop* loop, const unsigned char* palette, int colours);
}

// The functions' names; a module of another interface has others.
inline constexpr const char kAaWritePdf[] = "aaWritePdf1", kAaWriteWebp[] = "aaWriteWebp1",
                            kAaWriteGif[] = "aaWriteGif1";
