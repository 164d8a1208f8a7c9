// Contact sheets. Rows: a row per method (ground truth first, then from best to worst PSNR) with its
// figures, the whole frame, magnified crops, maps of the error on one fixed scale. Grid: methods side by side, a row
// per crop. Strips: a row per method and a column per frame of a crop. Loops: the crops in place, method after method
// or frame after frame. Crops are unfiltered pixels, magnified by whole factors.
#pragma once
#include "metrics/maps.h"
#include "report/gallery.h"
#include "report/sheet_pages.h"

namespace aa {

// Methods as indices in the order of every table and sheet: best to worst pooled PSNR; methods without
// figures keep their order before it.
std::vector<size_t> presentationOrder(const RunResults& run);
// Those that are named by their text, id or family, in that order; of no names all. Throws UsageError: no such method.
std::vector<size_t> chosenMethods(const RunResults& run, const std::vector<std::string>& names);
// The run with these methods alone, in this order.
RunResults onlyMethods(const RunResults& run, const std::vector<size_t>& order);

struct Crop {
    Window window;
    std::string label = {};
};
// "X,Y,WIDTH,HEIGHT" or "X,Y,WIDTH,HEIGHT:LABEL". Throws UsageError.
Crop cropFrom(const std::string& text, const RunResults& run);

enum class Arrangement { rows, grid };
struct SheetOptions {
    std::vector<Crop> crops = {};  // none: those of tellingCrops
    Arrangement arrangement = Arrangement::rows;
    bool frameColumn = true, cropColumns = true;  // of rows
    std::vector<const MapKind*> maps = {&mapKindByName("error")};
    bool asksForMaps = false;  // without truth those that were not asked for are left out
    bool light = false;
    int zoom = 0;  // of crops; 0: what fits
    PageSize page = PageSize::free;
};
// Of what columns there are: "frame", "crops", names of maps. Throws UsageError.
void chooseColumns(SheetOptions& options, const std::vector<std::string>& names);

// What is shown: a run, methods of it, and how their pictures are had. Pictures::methods are parallel to `order`.
struct Shown {
    const RunResults& run;
    std::vector<size_t> order;
    std::function<Pictures(int frame)> pictures;
};
// Throw UsageError where it does not fit, InputError where pictures cannot be read.
std::vector<Canvas> sheet(const Shown& shown, int frame, const SheetOptions& options, const Exec& exec);
std::vector<Canvas> strips(const Shown& shown, const std::vector<int>& frames, const SheetOptions& options);
// Canvases of one size.
std::vector<Canvas> loopOfMethods(const Shown& shown, int frame, const SheetOptions& options);
std::vector<Canvas> loopOfFrames(const Shown& shown, const std::vector<int>& frames, const SheetOptions& options);

}  // namespace aa
