// Canvases as files, by the ending of the name: PNG, WebP (lossless), PDF (text as text, pictures without loss); GIF
// and animated PNG for pictures that follow each other, which WebP holds too.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "report/canvas.h"

namespace aa {

enum class DocumentKind { png, webp, pdf, gif, apng };
// Throws UsageError, with what there is, on another ending; `option` is what named the file.
DocumentKind documentKindOf(const std::filesystem::path& file, const std::string& option);
inline bool holdsPages(DocumentKind kind) { return kind <= DocumentKind::pdf; }
inline bool holdsLoops(DocumentKind kind) { return kind != DocumentKind::png && kind != DocumentKind::pdf; }

// A PDF holds all pages; of the other kinds a second page makes it NAME-1.png, NAME-2.png ..., or, where the
// first keeps its name, NAME.png, NAME-2.png. Returns the files.
// Throws InputError: cannot be written, no module.
std::vector<std::filesystem::path> writePages(const std::vector<Canvas>& pages, const std::filesystem::path& file,
                                              const std::string& title, bool firstKeepsName = false);
// Of one size, each for as long. GIF has 256 colours for all; the others lose nothing.
void writeLoop(const std::vector<Canvas>& frames, int milliseconds, const std::filesystem::path& file);

}  // namespace aa
