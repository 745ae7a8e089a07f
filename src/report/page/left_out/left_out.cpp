// In place of the report's parts, in a build without them.
#include "report/report.h"
#include "report/report_assets.h"

namespace edgeslam {

bool reportsAreBuiltIn() { return false; }

ReportAssets reportAssets() { return {}; }

}  // namespace edgeslam
