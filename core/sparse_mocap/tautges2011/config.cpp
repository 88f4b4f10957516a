// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/config.hpp"

#include <algorithm>
#include <string>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap::tautges2011 {

Config Config::scaled_to(int num_frames) const {
  Config scaled = *this;
  if (scales_with_database) {
    const int most_neighbours = static_cast<int>(kNeighbourShare * num_frames);
    const int most_paths = std::max(kFewestPaths, static_cast<int>(kPathShare * num_frames));
    scaled.num_neighbours = std::min(num_neighbours, std::max(most_neighbours, 1));
    scaled.num_paths = std::min({num_paths, std::max(scaled.num_neighbours / 4, 1), most_paths});
  }
  scaled.num_paths = std::min(scaled.num_paths, scaled.num_neighbours);
  return scaled;
}

const std::vector<PresetInfo>& presets() {
  static const std::vector<PresetInfo> list{{"paper", "The numbers that the paper states."}};
  return list;
}

const OptionTable<Config>& options() {
  static const auto table =
      OptionTable<Config>()
          .integer("num_neighbours", &Config::num_neighbours, 1, 1'000'000,
                   "K: frames of the database that are retrieved for each reading")
          .integer("num_paths", &Config::num_paths, 1, 1'000'000,
                   "I: best paths that the pose is made from")
          .integer("window_readings", &Config::window_readings, 1, 10'000,
                   "M: readings that a path reaches back at most")
          .number("penalty", &Config::penalty, 0.0, 100.0,
                  "cost of a reading that a path skips, in distances of its farthest neighbour")
          .flag("is_time_warping", &Config::is_time_warping,
                "whether paths may run at half to double speed (figure 13)")
          .choice("prior", &Config::prior, {"kernel", "mahalanobis", "normal"},
                  "the prior models that figure 11 compares")
          .choice(
              "pose", &Config::pose, {"energy", "mean"},
              "how a pose is made: as the minimum of the energy, or as the paths' weighted mean")
          .number("w_contr", &Config::w_contr, 0.0, 1e6, "weight of the control term")
          .number("w_prior", &Config::w_prior, 1e-6, 1e6, "weight of the three priors together")
          .number("w_pose", &Config::w_pose, 1e-6, 1e6, "weight of the pose prior")
          .number("w_motion", &Config::w_motion, 0.0, 1e6, "weight of the motion prior")
          .number("w_smooth", &Config::w_smooth, 0.0, 1e6, "weight of the smoothness prior")
          .number("pca_variance", &Config::pca_variance, 0.01, 1.0,
                  "share of the poses' variance that the pose may vary in")
          .integer("max_iterations", &Config::max_iterations, 1, 10'000,
                   "steps of the minimisation, at most")
          .number("follow_s", &Config::follow_s, 0.0, 10.0,
                  "how far poses lag behind those of the paper, so that none jumps; 0: not at all")
          .flag("scales_with_database", &Config::scales_with_database,
                "whether K and I shrink with databases smaller than the paper's");
  return table;
}

Config config_of(const MethodSettings& settings) {
  if (!settings.preset.empty() && settings.preset != presets().front().name)
    throw ConfigError("unknown preset '" + settings.preset + "'; tautges2011 has paper");
  Config config;
  options().apply(settings.options, config);
  return config;
}

}  // namespace sparse_mocap::tautges2011
