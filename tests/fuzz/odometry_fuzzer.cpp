// Messages on the wheel odometry's channel: a pose that can be, or nothing; and what the odometry's scale makes of
// them is left to its own tests.
#include <cmath>

#include "drivers/lcm/odometry.h"
#include "fuzz_input.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edgeslam;
  const std::optional<OdometryPose> pose = checkOdometry(data, size);
  if (!pose) return 0;
  require(pose->utime >= 0 && pose->utime <= 100'000'000'000'000'000, "time stamps are in range");
  require(pose->local_T_body.translation.allFinite(), "positions are finite");
  require(pose->local_T_body.translation.cwiseAbs().maxCoeff() <= 1e7, "positions are on Earth");
  require(std::abs(pose->local_T_body.rotation.norm() - 1) < 1e-9, "rotations are unit quaternions");
  return 0;
}
