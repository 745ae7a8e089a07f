// In place of the pages' parts, in a build without reports.
#include "benchmark/page_assets.h"

namespace edgeslam {

PageAssets pageAssets() { return {}; }

}  // namespace edgeslam
