// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/minimisation.hpp"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <cmath>
#include <exception>

namespace sparse_mocap::eom2014 {
namespace {

class Cost : public ceres::FirstOrderFunction {
 public:
  Cost(const Function& function, Eigen::Index size) : function_(function), size_(size) {}

  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(parameters, size_);
    Eigen::VectorXd by_parameters(size_);
    *cost = function_(at, gradient == nullptr ? nullptr : &by_parameters);
    if (!std::isfinite(*cost)) return false;
    if (gradient != nullptr) Eigen::Map<Eigen::VectorXd>(gradient, size_) = by_parameters;
    return true;
  }
  int NumParameters() const override { return static_cast<int>(size_); }

 private:
  const Function& function_;
  Eigen::Index size_;
};

// Ceres must not see exceptions: a report that cancels is kept until it has stopped.
class Reporter : public ceres::IterationCallback {
 public:
  Reporter(const Progress& progress, int total, std::string_view what)
      : progress_(progress), total_(static_cast<std::size_t>(total)), what_(what) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    try {
      progress_.report(static_cast<std::size_t>(summary.iteration), total_, what_);
    } catch (...) {
      thrown_ = std::current_exception();
      return ceres::SOLVER_ABORT;
    }
    return ceres::SOLVER_CONTINUE;
  }
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  const Progress& progress_;
  std::size_t total_;
  std::string_view what_;
  std::exception_ptr thrown_;
};

}  // namespace

Eigen::VectorXd minimum(const Function& function, const Eigen::VectorXd& start, int max_iterations,
                        double tolerance, const Progress& progress, std::string_view what) {
  const ceres::GradientProblem problem(new Cost(function, start.size()));
  Reporter reporter(progress, max_iterations, what);
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::LBFGS;
  options.line_search_type = ceres::WOLFE;
  options.max_lbfgs_rank = 50;
  options.use_approximate_eigenvalue_bfgs_scaling = true;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = tolerance;
  options.logging_type = ceres::SILENT;
  options.callbacks.push_back(&reporter);
  ceres::GradientProblemSolver::Summary summary;
  Eigen::VectorXd found = start;
  ceres::Solve(options, problem, found.data(), &summary);
  reporter.rethrow();
  return found;
}

}  // namespace sparse_mocap::eom2014
