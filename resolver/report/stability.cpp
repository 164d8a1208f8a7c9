#include "report/stability.h"

#include "report/page.h"
#include "report/web/web_files.h"

namespace aa {

std::string stabilityForReport(const std::filesystem::path& folder) {
    return sectionOf({"stability.json", "aaresolve-stability", "stability", "stability-data", web::stability}, folder);
}

}  // namespace aa
