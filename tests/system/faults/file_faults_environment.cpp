// For tests whose program is to have the faults, and not they themselves.
#include "system/faults/file_faults.h"

namespace edgeslam {

std::vector<std::string> faultEnvironment(const std::string& library, const FaultPlan& plan) {
  return {"LD_PRELOAD=" + library,
          "EDGESLAM_FAULT_UNDER=" + plan.under,
          "EDGESLAM_FAULT=" + std::to_string(static_cast<int>(plan.fault)),
          "EDGESLAM_FAULT_FIRST=" + std::to_string(plan.first),
          "EDGESLAM_FAULT_WHILE=" + plan.while_exists,
          "EDGESLAM_FAULT_LOG=" + plan.log};
}

}  // namespace edgeslam
