#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <planner/pose_shortcut.hpp>

namespace talus::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<std::size_t, 8> kSpans{2, 3, 4, 6, 8, 12, 16, 24};
constexpr int kRounds = 2;
constexpr double kWorthwhile = 2e-3;  // share of the price below which another round is not tried

double apart_m(const Pose& a, const Pose& b) noexcept {
  return std::hypot(b.place.x_m - a.place.x_m, b.place.y_m - a.place.y_m);
}

// The same drive in legs no longer than so many metres.
PosePath divided(const PosePath& path, double longest_m) {
  PosePath fine{.start = path.start, .legs = {}};
  for (const auto& leg : path.legs) {
    const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(leg.arc.length_m) / longest_m)));
    for (int k = 0; k < parts; ++k)
      fine.legs.push_back({{leg.arc.length_m / parts, leg.arc.curvature_1_m}, leg.turn_rad});
  }
  return fine;
}

// The best way found to a joint of the drive.
struct Joint {
  Pose pose;
  double price = kInfinity;
  std::size_t from = 0;             // joint before
  std::vector<PosePath::Leg> legs;  // from there to here
  int direction = 0;                // of travel on arrival
};

// Dynamic programming over the joints of a drive: each is reached from the one before by the drive's own leg,
// or by the direct curve from a joint further back.
class Shortening {
 public:
  Shortening(const PosePath& path, const PoseCost& cost, double cheapest_J_per_m)
      : cost_(cost), cheapest_J_per_m_(cheapest_J_per_m), joints_(path.legs.size() + 1) {
    joints_[0].pose = path.start;
    joints_[0].price = 0.0;
    for (std::size_t k = 1; k < joints_.size(); ++k) {
      joints_[k].pose = after(joints_[k - 1].pose, path.legs[k - 1]);
      reach(k, k - 1, {path.legs[k - 1]});
      for (const std::size_t span : kSpans) {
        if (span > k) break;
        if (promising(k, k - span)) reach(k, k - span, direct(path, k - span, k));
      }
    }
  }

  // The drive itself where its end cannot be reached.
  PosePath result(const PosePath& given) const {
    if (joints_.back().price == kInfinity) return given;
    std::vector<std::size_t> chain;
    for (std::size_t k = joints_.size() - 1; k > 0; k = joints_[k].from) chain.push_back(k);
    PosePath path{.start = joints_[0].pose, .legs = {}};
    for (auto k = chain.rbegin(); k != chain.rend(); ++k)
      path.legs.insert(path.legs.end(), joints_[*k].legs.begin(), joints_[*k].legs.end());
    return path;
  }

 private:
  bool promising(std::size_t to, std::size_t from) const noexcept {
    return joints_[from].price + cheapest_J_per_m_ * apart_m(joints_[from].pose, joints_[to].pose) <
           joints_[to].price;
  }

  // Far apart, and driven forward so far: reversing would not pay, and forward curves are found sooner.
  std::vector<PosePath::Leg> direct(const PosePath& path, std::size_t from, std::size_t to) const {
    const Pose &a = joints_[from].pose, &b = joints_[to].pose;
    const bool forward = apart_m(a, b) > 4.0 * cost_.kinematics().turning_radius_m &&
                         direction(path.legs[from]) > 0 && direction(path.legs[to - 1]) > 0;
    return cost_.direct(a, b, forward);
  }

  void reach(std::size_t to, std::size_t from, std::vector<PosePath::Leg> legs) {
    Joint& there = joints_[to];
    double price = joints_[from].price;
    int way = joints_[from].direction;
    Pose pose = joints_[from].pose;
    for (const auto& leg : legs) {
      const int now = direction(leg);
      if (now * way < 0) price += cost_.kinematics().cusp.cost_J;
      if (now != 0) way = now;
      price += cheapest_J_per_m_ * std::abs(leg.arc.length_m);
    }
    if (price >= there.price) return;
    for (const auto& leg : legs) {
      price += cost_(pose, leg) - cheapest_J_per_m_ * std::abs(leg.arc.length_m);
      if (price >= there.price) return;
      pose = after(pose, leg);
    }
    there.price = price;
    there.from = from;
    there.legs = std::move(legs);
    there.direction = way;
  }

  const PoseCost& cost_;
  double cheapest_J_per_m_;
  std::vector<Joint> joints_;
};

}  // namespace

PosePath shortened(const PosePath& path, const PoseCost& cost, const ShortenOptions& options) {
  PosePath best = path;
  double price = cost(best);
  for (int round = 0; round < kRounds; ++round) {
    const PosePath fine = divided(best, options.joint_m);
    PosePath shorter = Shortening(fine, cost, options.cheapest_J_per_m).result(fine);
    const double shorter_price = cost(shorter);
    if (!(shorter_price < price)) break;
    const bool enough = shorter_price > price * (1.0 - kWorthwhile);
    best = std::move(shorter);
    price = shorter_price;
    if (enough) break;
  }
  return best;
}

}  // namespace talus::planner
