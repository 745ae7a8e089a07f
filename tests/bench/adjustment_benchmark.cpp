// Local bundle adjustment over 5 keyframes and 1000 points (two more keyframes are fixed and hold the gauge), beside
// Ceres with the same unknowns and beside the plain formulation with 3D points; the same observations, loss and stop
// criterion, one thread.
// usage: adjustment_benchmark [--benchmark_...]
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "adjustment/bundle_adjustment.h"
#include "bench/plain_bundle_adjustment.h"
#include "bench/ratio_reporter.h"
#include "unit/adjustment/ceres_bundle_adjustment.h"
#include "unit/adjustment/synthetic_bundle.h"

namespace edgeslam {
namespace {

using test::Random;
using test::uniform;

using Adjustment = std::function<int(const Camera&, BundleProblem&, const BundleOptions&)>;

struct Variant {
  std::string name;
  Adjustment adjust;
};

// A fifth of the points are corners; every hundredth observation is an outlier.
test::BundleScene makeScene(int free, int fixed, int points) {
  Random random(1);
  test::BundleSceneOptions options;
  options.cameras = free + fixed;
  options.fixed = fixed;
  options.points = points;
  test::BundleScene scene = test::makeBundleScene(random, options);
  for (BundleObservation& o : scene.truth.observations) {
    const bool corner = o.point % 5 == 0;
    o.measurement = test::measure(random, o.measurement.pixel, uniform(random, -M_PI, M_PI), corner ? 0.17 : 0.5,
                                  corner ? 0.3 : 20, 1);
    if (uniform(random, 0, 1) < 0.01) o.measurement.pixel += 20 * o.measurement.normal;
  }
  return scene;
}

// What mapping meets: the newest keyframe's pose is from tracking, the others were adjusted before.
BundleProblem start(const test::BundleScene& scene) {
  Random random(2);
  BundleProblem problem = scene.truth;
  for (BundleCamera& c : problem.cameras) {
    const bool newest = &c == &problem.cameras.back();
    if (!c.fixed)
      c.world_T_camera = test::perturbed(random, c.world_T_camera, newest ? 0.02 : 0.004, newest ? 0.01 : 0.001);
  }
  for (BundlePoint& p : problem.points) p.inverse_depth *= uniform(random, 0.95, 1.05);
  return problem;
}

void add(const std::string& group, const test::BundleScene& scene, const BundleOptions& options,
         const std::vector<Variant>& variants) {
  const BundleProblem problem = start(scene);
  std::printf("%s: %zu observations\n", group.c_str(), problem.observations.size());
  for (const Variant& variant : variants) {
    BundleProblem adjusted = problem;
    const int iterations = variant.adjust(scene.camera, adjusted, options);
    BundleProblem copy = adjusted;
    const BundleResult judged = adjustBundle(scene.camera, copy, {0, options.huber});
    std::printf("  %-16s %2d iterations, cost %.4f -> %.4f, largest error of a centre %.5f, of a rotation %.5f rad\n",
                variant.name.c_str(), iterations,
                adjustBundle(scene.camera, copy = problem, {0, options.huber}).final_cost, judged.final_cost,
                test::largestTranslationError(adjusted, scene.truth),
                test::largestRotationError(adjusted, scene.truth));
    benchmark::RegisterBenchmark((group + "/" + variant.name).c_str(), [=](benchmark::State& state) {
      for (auto _ : state) {
        BundleProblem again = problem;
        benchmark::DoNotOptimize(variant.adjust(scene.camera, again, options));
      }
    })->Unit(benchmark::millisecond);
  }
}

}  // namespace
}  // namespace edgeslam

int main(int argc, char** argv) {
  using namespace edgeslam;
  benchmark::Initialize(&argc, argv);
  const std::vector<Variant> variants = {
      {"ours",
       [](const Camera& c, BundleProblem& p, const BundleOptions& o) { return adjustBundle(c, p, o).iterations; }},
      {"ceres", test::adjustBundleByCeres},
      {"plain_dense",
       [](const Camera& c, BundleProblem& p, const BundleOptions& o) { return adjustBundlePlainly(c, p, o, false); }},
      {"plain_sparse",
       [](const Camera& c, BundleProblem& p, const BundleOptions& o) { return adjustBundlePlainly(c, p, o, true); }}};
  const test::BundleScene local = makeScene(5, 2, 1000);
  add("local_bundle", local, BundleOptions(), variants);
  add("to_convergence", local, BundleOptions{50, 2.0}, variants);
  RatioReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return 0;
}
