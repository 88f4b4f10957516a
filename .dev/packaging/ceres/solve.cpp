// SPDX-License-Identifier: GPL-3.0-or-later
#include <ceres/ceres.h>

#include <cmath>

namespace {

struct Powell {
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    residual[0] = x[0] + 10.0 * x[1];
    residual[1] = std::sqrt(5.0) * (x[2] - x[3]);
    residual[2] = (x[1] - 2.0 * x[2]) * (x[1] - 2.0 * x[2]);
    residual[3] = std::sqrt(10.0) * (x[0] - x[3]) * (x[0] - x[3]);
    return true;
  }
};

}  // namespace

// Powell's singular function, whose minimum is zero at the origin.
int main() {
  double x[4] = {3.0, -1.0, 0.0, 1.0};
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Powell, 4, 4>(new Powell), nullptr, x);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-20;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (const double value : x) {
    if (!(std::abs(value) < 1e-3)) {
      return 1;
    }
  }
  return summary.IsSolutionUsable() ? 0 : 1;
}
