#include "calibration/readout_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "files/format_text.h"

namespace edgeslam {
namespace {

constexpr double coarse_step_s = 0.01, fine_step_s = 0.002, fine_reach_s = 0.006;
constexpr std::size_t stretches = 10, fewest_stretches = 5, most_contradicting = 2;
constexpr std::size_t fewest_frames = 100;  // that say something
// Errors with the worst readout tried over those with the best one. Motion so slow that it makes less of a difference
// is known too badly from frame to frame: that alone speaks against long readouts.
constexpr double least_gain = 1.6;
constexpr double largest_sigma_s = 0.004;  // else the recording does not say
constexpr double lost = 2;  // a frame that says nothing counts as so many times the worst that others say of it

using Errors = std::vector<double>;  // logarithms, of the frames that count

// Logarithms: a frame counts by how many times better it fits, not by how large its errors are. A frame that is lost
// with one readout and not with another speaks against it.
std::vector<Errors> comparableErrors(const std::vector<ReadoutTrial>& trials) {
  std::vector<Errors> comparable(trials.size());
  std::size_t frames = trials.front().errors.size();
  for (const ReadoutTrial& trial : trials) frames = std::min(frames, trial.errors.size());
  for (std::size_t i = 0; i < frames; ++i) {
    double worst = 0;
    std::size_t told = 0;
    for (const ReadoutTrial& trial : trials) {
      worst = std::max(worst, trial.errors[i]);
      told += trial.errors[i] > 0 ? 1 : 0;
    }
    if (2 * told < trials.size()) continue;
    for (std::size_t k = 0; k < trials.size(); ++k) {
      const double error = trials[k].errors[i];
      comparable[k].push_back(std::log(error > 0 ? error : lost * worst));
    }
  }
  return comparable;
}

// Of a part of the frames, one a trial.
Errors meansOf(const std::vector<Errors>& errors, std::size_t begin, std::size_t end) {
  Errors means;
  for (const Errors& of_trial : errors) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += of_trial[i];
    means.push_back(sum / static_cast<double>(end - begin));
  }
  return means;
}

// Where the least-squares parabola through the trials within reach of `centre` is lowest; nothing where it is nowhere.
std::optional<double> lowestOfParabola(const std::vector<ReadoutTrial>& trials, const Errors& errors, double centre) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < trials.size(); ++k) {
    const double x = (trials[k].readout_s - centre) / fine_reach_s;
    if (std::abs(x) > 1.01) continue;
    const Eigen::Vector3d row(1, x, x * x);
    information += row * row.transpose();
    right += errors[k] * row;
  }
  const Eigen::Vector3d parabola = information.ldlt().solve(right);
  if (!parabola.allFinite() || !(parabola.z() > 0)) return std::nullopt;
  return centre + std::clamp(-0.5 * parabola.y() / parabola.z(), -1.0, 1.0) * fine_reach_s;
}

// True where a trial farther away than what is tried around `centre` fits clearly better than all of those.
bool contradicts(const std::vector<ReadoutTrial>& trials, const Errors& errors, double centre) {
  double near = std::numeric_limits<double>::infinity(), far = near;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    double& least = std::abs(trials[k].readout_s - centre) < 1.01 * fine_reach_s ? near : far;
    least = std::min(least, errors[k]);
  }
  return near - far > std::log(least_gain);
}

double scatterOf(const std::vector<double>& values) {
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  const double mean = sum / static_cast<double>(values.size());
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

ReadoutEstimate estimateFrom(const std::vector<ReadoutTrial>& trials, double centre) {
  ReadoutEstimate estimate;
  const std::vector<Errors> errors = comparableErrors(trials);
  const std::size_t frames = errors.front().size();
  if (frames < fewest_frames) {
    estimate.problem = "only " + std::to_string(frames) + " of " + std::to_string(trials.front().errors.size()) +
                       " frames see enough of a map, " + std::to_string(fewest_frames) + " are needed";
    return estimate;
  }
  const Errors means = meansOf(errors, 0, frames);
  const double least = *std::min_element(means.begin(), means.end());
  estimate.error_best = std::exp(least);
  for (std::size_t k = 0; k < trials.size(); ++k) {
    if (trials[k].readout_s == 0) estimate.error_global = std::exp(means[k]);
  }
  if (*std::max_element(means.begin(), means.end()) - least < std::log(least_gain)) {
    estimate.problem = "the readout makes too little difference: move the camera faster";
    return estimate;
  }
  std::vector<double> of_stretches;
  std::size_t contradicting = 0;
  for (std::size_t s = 0; s < stretches; ++s) {
    const Errors of_stretch = meansOf(errors, s * frames / stretches, (s + 1) * frames / stretches);
    if (const auto lowest = lowestOfParabola(trials, of_stretch, centre)) of_stretches.push_back(*lowest);
    contradicting += contradicts(trials, of_stretch, centre) ? 1 : 0;
  }
  if (contradicting > most_contradicting) {
    estimate.problem = "parts of the recording ask for very different readouts: is it of one camera in one mode?";
    return estimate;
  }
  const std::optional<double> lowest = lowestOfParabola(trials, means, centre);
  if (!lowest || of_stretches.size() < fewest_stretches) {
    estimate.problem = "no readout fits better than those around it: move the camera more, before more texture";
    return estimate;
  }
  estimate.readout_s = *lowest;
  // No fit is better than half of what the trials are apart.
  estimate.sigma_s =
      std::hypot(scatterOf(of_stretches) / std::sqrt(static_cast<double>(of_stretches.size())), 0.5 * fine_step_s);
  if (estimate.sigma_s > largest_sigma_s) {
    estimate.problem = formatted("the readout is known to %.1f ms only: move the camera more, before more texture",
                                 1e3 * estimate.sigma_s);
  }
  return estimate;
}

double bestOf(const std::vector<ReadoutTrial>& trials) {
  const std::vector<Errors> errors = comparableErrors(trials);
  if (errors.front().empty()) return 0;
  const Errors means = meansOf(errors, 0, errors.front().size());
  return trials[static_cast<std::size_t>(std::min_element(means.begin(), means.end()) - means.begin())].readout_s;
}

void tryAround(double centre, double longest_s, const TryReadouts& tryReadouts, std::vector<ReadoutTrial>& trials) {
  std::vector<double> readouts;
  const int reach = static_cast<int>(std::lround(fine_reach_s / fine_step_s));
  for (int i = -reach; i <= reach; ++i) {
    const double readout = centre + i * fine_step_s;
    const bool is_tried = std::any_of(trials.begin(), trials.end(), [&](const ReadoutTrial& trial) {
      return std::abs(trial.readout_s - readout) < 0.1 * fine_step_s;
    });
    if (!is_tried && std::abs(readout) <= longest_s + fine_reach_s) readouts.push_back(readout);
  }
  const std::vector<ReadoutTrial> more = tryReadouts(readouts);
  trials.insert(trials.end(), more.begin(), more.end());
}

}  // namespace

ReadoutEstimate searchReadout(double longest_s, const TryReadouts& tryReadouts) {
  std::vector<double> coarse;
  const int reach = static_cast<int>(longest_s / coarse_step_s + 1e-6);
  for (int i = -reach; i <= reach; ++i) coarse.push_back(i * coarse_step_s);
  std::vector<ReadoutTrial> trials = tryReadouts(coarse);
  // The best of the coarse readouts may be half a step off, and the fine ones around it reach little farther.
  double centre = bestOf(trials);
  for (int round = 0; round < 2; ++round) {
    tryAround(centre, longest_s, tryReadouts, trials);
    const double better = bestOf(trials);
    if (std::abs(better - centre) < 0.5 * fine_reach_s) break;
    centre = better;
  }
  return estimateFrom(trials, centre);
}

}  // namespace edgeslam
