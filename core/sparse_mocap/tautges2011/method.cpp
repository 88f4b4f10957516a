// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/method.hpp"

#include "sparse_mocap/sensors/sites.hpp"
#include "sparse_mocap/tautges2011/config.hpp"
#include "sparse_mocap/tautges2011/reconstructor.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

std::vector<Experiment> experiments() {
  std::vector<Experiment::Variant> windows;
  for (const char* readings : {"1", "2", "4", "8", "16", "32", "64"})
    windows.push_back({std::string("M = ") + readings, {{"window_readings", readings}}});
  return {
      {"window", "Window size M of the neighbourhood graph (figure 9b)", windows, {}},
      {"prior",
       "Kernel regression against normal distributions (figure 11)",
       {{"kernel regression", {{"prior", "kernel"}}},
        {"Mahalanobis distances", {{"prior", "mahalanobis"}}},
        {"normal distribution, ad-hoc smoothness", {{"prior", "normal"}}}},
       {}},
      {"time_warping",
       "Paths at half to double speed against the recorded speed only (figure 13b)",
       {{"with time warping", {{"is_time_warping", "true"}}},
        {"without", {{"is_time_warping", "false"}}}},
       {}},
  };
}

}  // namespace

MethodEntry method() {
  MethodEntry entry;
  entry.info.name = "tautges2011";
  entry.info.title = "Tautges et al. 2011";
  entry.info.summary = "The method of the paper, for a few accelerometers.";
  entry.info.paper =
      "Tautges, Zinke, Krueger, Baumann, Weber, Helten, Mueller, Seidel, Eberhardt: Motion "
      "Reconstruction Using Sparse Accelerometer Data, ACM Trans. Graph. 30 (2011)";
  entry.info.presets = presets();
  entry.info.options = options().described(Config());
  entry.info.required_channels = Channel::specific_force;
  entry.info.most_sensors = static_cast<int>(all_sites().size());
  entry.info.needs_database = true;
  entry.info.experiments = experiments();
  entry.make_live = [](const MethodSettings& settings,
                       const MethodContext& context) -> std::unique_ptr<LiveMethod> {
    return std::make_unique<Reconstructor>(config_of(settings), context);
  };
  return entry;
}

}  // namespace sparse_mocap::tautges2011
