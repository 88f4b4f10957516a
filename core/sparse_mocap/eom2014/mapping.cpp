// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/mapping.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "sparse_mocap/eom2014/frame_path.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr double kUnlikelyType = 1e-3;
constexpr double kRidge = 1e-3;  // of linear maps, in features of a length near 1 a frame
const Eigen::Vector3d kDirectKernel{1.0, 0.7, 0.05};  // of the Gaussian process to poses

// Linear least squares with a ridge, from rows to rows.
Eigen::MatrixXd linear(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& outputs,
                       const Eigen::MatrixXd& wanted) {
  const Eigen::RowVectorXd mean = outputs.colwise().mean(), centre = inputs.colwise().mean();
  const Eigen::MatrixXd centred = inputs.rowwise() - centre;
  Eigen::MatrixXd normal = centred.transpose() * centred;
  normal.diagonal().array() += kRidge * static_cast<double>(inputs.rows());
  const Eigen::MatrixXd map = normal.ldlt().solve(centred.transpose() * (outputs.rowwise() - mean));
  return ((wanted.rowwise() - centre) * map).rowwise() + mean;
}

Eigen::MatrixXd gaussian_process(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& outputs,
                                 const Eigen::MatrixXd& wanted) {
  const PoseKernel kernel{kDirectKernel};
  const Eigen::RowVectorXd mean = outputs.colwise().mean();
  const Eigen::MatrixXd coefficients = kernel.matrix(inputs).ldlt().solve(outputs.rowwise() - mean);
  return (kernel.between(wanted, inputs) * coefficients).rowwise() + mean;
}

// Poses and how the root moved into them, of the frames that the model was trained on.
Eigen::MatrixXd training_outputs(const MotionType& type) {
  const MotionData& data = type.motion.data();
  Eigen::MatrixXd out(data.poses.rows(), kNumPoseChannels + 3);
  out.leftCols(kNumPoseChannels) = data.poses;
  for (Eigen::Index row = 0; row < data.velocities.rows(); ++row)
    out.row(data.steps[static_cast<std::size_t>(row)]).tail<3>() =
        data.velocities.row(row).tail<3>();
  for (const int begin : type.begins) out.row(begin).tail<3>() = out.row(begin + 1).tail<3>();
  return out;
}

Eigen::MatrixXd by_phase(const SiteModel& site, const Eigen::MatrixXd& inputs,
                         const std::vector<Phase>& phases) {
  Eigen::MatrixXd X(inputs.rows(), site.perceptron.W2.rows());
  for (Eigen::Index t = 0; t < inputs.rows(); ++t) {
    const auto known = std::find(site.recognition.phases.begin(), site.recognition.phases.end(),
                                 phases[static_cast<std::size_t>(t)]);
    const auto p = static_cast<std::size_t>(known - site.recognition.phases.begin());
    X.row(t) = site.of_each_phase[p](inputs.row(t).transpose()).transpose();
  }
  return X;
}

// What one type of motion makes of readings.
class TypeMapping {
 public:
  TypeMapping(const MotionType& type, std::size_t site, const ReadingRows& readings,
              const Config& config)
      : type_(type),
        site_(type.sites[site]),
        config_(config),
        inputs_(features(readings, site_.scale, config.window_frames)),
        known_inputs_(
            sequence_features(site_.readings, type.begins, site_.scale, config.window_frames)),
        posterior_(frame_posterior(inputs_, known_inputs_, type.begins, config.path_width)),
        phases_(site_.recognition.recognised(readings, config.vote_frames)) {
    if (config.mapping != Mapping::direct_linear && config.mapping != Mapping::gaussian_process)
      latent_ = latent_points();
  }

  const std::vector<Phase>& phases() const { return phases_; }
  const Eigen::MatrixXd& latent() const { return latent_; }

  // Channels of poses, and how the root moves into them, of the frames of a range.
  Eigen::MatrixXd outputs(const FrameRange& range) const {
    if (latent_.rows() == 0) {
      const auto regression = config_.mapping == Mapping::direct_linear ? linear : gaussian_process;
      return regression(known_inputs_, training_outputs(type_),
                        inputs_.middleRows(range.begin, range.size()));
    }
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(range.size(), kNumPoseChannels + 3);
    for (Eigen::Index t = range.begin; t < range.end; ++t) {
      const Eigen::VectorXd x = latent_.row(t);
      out.row(t - range.begin).head(kNumPoseChannels) =
          type_.motion.pose(x).transpose();  // equation 7
      if (t == 0) continue;
      out.row(t - range.begin).tail<3>() =
          type_.motion.velocity(x, latent_.row(t - 1).transpose()).tail<3>().transpose();
    }
    return out;
  }

  int likeliest_frame(Eigen::Index t) const {
    Eigen::Index frame = 0;
    posterior_.row(t).maxCoeff(&frame);
    return static_cast<int>(frame);
  }

  // What training frames have, by how likely they are.
  std::vector<ExtremityVote> extremities(const FrameRange& range) const {
    return extremity_votes(type_.extremities, posterior_.middleRows(range.begin, range.size()));
  }

 private:
  Eigen::MatrixXd latent_points() const {
    const Eigen::MatrixXd& X = type_.motion.latent().X;
    if (config_.mapping == Mapping::phases) return by_phase(site_, inputs_, phases_);
    if (config_.mapping == Mapping::linear) return linear(known_inputs_, X, inputs_);
    if (config_.mapping == Mapping::path) return posterior_ * X;
    Eigen::MatrixXd out(inputs_.rows(), X.cols());
    for (Eigen::Index t = 0; t < inputs_.rows(); ++t)
      out.row(t) = site_.perceptron(inputs_.row(t).transpose()).transpose();
    return out;
  }

  const MotionType& type_;
  const SiteModel& site_;
  const Config& config_;
  Eigen::MatrixXd inputs_, known_inputs_;
  Eigen::MatrixXd posterior_;  // readings x training frames
  std::vector<Phase> phases_;
  Eigen::MatrixXd latent_;
};

}  // namespace

MappedFrames mapped(const TrainedModel& model, std::size_t site, const KnownReadings& known,
                    const ReadingRows& readings, const Config& config, const FrameRange& range) {
  Eigen::MatrixXd weights = type_weights(readings, known).middleRows(range.begin, range.size());
  weights = (weights.array() < kUnlikelyType).select(0.0, weights);
  MappedFrames out;
  out.types.resize(static_cast<std::size_t>(range.size()));
  for (Eigen::Index t = 0; t < range.size(); ++t)
    weights.row(t).maxCoeff(&out.types[static_cast<std::size_t>(t)]);
  out.phases.resize(out.types.size());
  out.extremities.resize(out.types.size());
  out.training_frames.resize(out.types.size());
  Eigen::MatrixXd outputs = Eigen::MatrixXd::Zero(range.size(), kNumPoseChannels + 3);
  for (std::size_t k = 0; k < model.types.size(); ++k) {
    const auto weight = weights.col(static_cast<Eigen::Index>(k));
    if (weight.maxCoeff() == 0.0) continue;
    const TypeMapping mapping(model.types[k], site, readings, config);
    outputs += weight.asDiagonal() * mapping.outputs(range);
    if (mapping.latent().rows() > 0 && out.latent.rows() == 0)
      out.latent.resize(range.size(), mapping.latent().cols());
    const auto votes = mapping.extremities(range);
    for (std::size_t t = 0; t < out.types.size(); ++t) {
      if (out.types[t] != static_cast<int>(k)) continue;
      const auto frame = range.begin + static_cast<Eigen::Index>(t);
      out.extremities[t] = votes[t];
      out.training_frames[t] = mapping.likeliest_frame(range.begin + static_cast<Eigen::Index>(t));
      out.phases[t] = mapping.phases()[static_cast<std::size_t>(frame)];
      if (out.latent.rows() > 0)
        out.latent.row(static_cast<Eigen::Index>(t)) = mapping.latent().row(frame);
    }
  }
  outputs.array().colwise() /= weights.rowwise().sum().array();
  out.poses = outputs.leftCols(kNumPoseChannels);
  out.root_velocities = outputs.rightCols<3>();
  if (range.begin == 0 && range.size() > 0) out.root_velocities.row(0).setZero();
  return out;
}

}  // namespace sparse_mocap::eom2014
