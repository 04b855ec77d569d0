#include "ndt/fit.hpp"

#include <cmath>

namespace landfix::ndt {

std::string_view to_string(Fit fit) noexcept {
  switch (fit) {
    case Fit::none:
      return "none";
    case Fit::weak:
      return "weak";
    case Fit::good:
      return "good";
  }
  return "unknown";
}

Fit judge(const MatchResult& match, const FitGates& gates) noexcept {
  // Where nothing stands the ground alone has to do.
  const double standing = match.no_ground_points == 0 ? 1.0 : match.standing_explained();
  const bool is_believed = match.converged && match.points >= gates.believed_points &&
                           match.likelihood() >= gates.believed_likelihood &&
                           standing >= gates.believed_standing_explained;
  if (!is_believed) return Fit::none;
  const double sigma_m = std::sqrt(match.covariance.diagonal().head<3>().maxCoeff());
  const bool is_good = match.points >= gates.good_points && match.likelihood() >= gates.good_likelihood &&
                       match.matched_share() >= gates.good_matched_share &&
                       standing >= gates.good_standing_explained && sigma_m <= gates.good_sigma_m;
  return is_good ? Fit::good : Fit::weak;
}

}  // namespace landfix::ndt
