// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/mapping.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "sparse_mocap/eom2014/frame_path.hpp"

namespace sparse_mocap::eom2014 {
namespace {

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
Eigen::MatrixXd training_outputs(const TrainedModel& model) {
  const MotionData& data = model.motion.data();
  Eigen::MatrixXd out(data.poses.rows(), kNumPoseChannels + 3);
  out.leftCols(kNumPoseChannels) = data.poses;
  for (Eigen::Index row = 0; row < data.velocities.rows(); ++row)
    out.row(data.steps[static_cast<std::size_t>(row)]).tail<3>() =
        data.velocities.row(row).tail<3>();
  for (const int begin : model.begins) out.row(begin).tail<3>() = out.row(begin + 1).tail<3>();
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

Eigen::MatrixXd latent_points(const TrainedModel& model, const SiteModel& site,
                              const Eigen::MatrixXd& inputs, const std::vector<Phase>& phases,
                              const Config& config) {
  const Eigen::MatrixXd& X = model.motion.latent().X;
  if (config.mapping == Mapping::phases) return by_phase(site, inputs, phases);
  if (config.mapping == Mapping::perceptron) {
    Eigen::MatrixXd out(inputs.rows(), X.cols());
    for (Eigen::Index t = 0; t < inputs.rows(); ++t)
      out.row(t) = site.perceptron(inputs.row(t).transpose()).transpose();
    return out;
  }
  const Eigen::MatrixXd known = training_features(site, model.begins, config.window_frames);
  if (config.mapping == Mapping::linear) return linear(known, X, inputs);
  return frame_posterior(inputs, known, model.begins, config.path_width) * X;
}

}  // namespace

MappedFrames mapped(const TrainedModel& model, const SiteModel& site, const ReadingRows& readings,
                    const Config& config) {
  const Eigen::MatrixXd inputs = features(readings, site.scale, config.window_frames);
  const Eigen::Index n = readings.rows();
  MappedFrames out;
  out.phases = site.recognition.recognised(readings, config.vote_frames);
  if (config.mapping == Mapping::direct_linear || config.mapping == Mapping::gaussian_process) {
    const Eigen::MatrixXd known = training_features(site, model.begins, config.window_frames);
    const auto regression = config.mapping == Mapping::direct_linear ? linear : gaussian_process;
    const Eigen::MatrixXd found = regression(known, training_outputs(model), inputs);
    out.poses = found.leftCols(kNumPoseChannels);
    out.root_velocities = found.rightCols(3);
    return out;
  }
  out.latent = latent_points(model, site, inputs, out.phases, config);
  out.poses.resize(n, kNumPoseChannels);
  out.root_velocities = Eigen::MatrixX3d::Zero(n, 3);
  for (Eigen::Index t = 0; t < n; ++t) {
    const Eigen::VectorXd x = out.latent.row(t);
    out.poses.row(t) = model.motion.pose(x).transpose();  // equation 7
    if (t == 0) continue;
    out.root_velocities.row(t) =
        model.motion.velocity(x, out.latent.row(t - 1).transpose()).tail<3>().transpose();
  }
  return out;
}

}  // namespace sparse_mocap::eom2014
