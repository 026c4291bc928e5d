#include "reference/converged/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace carom::converged {

namespace {

/// How many units of a run's last bit two impact times may differ by for one moment: an impact time is a
/// place over a speed, and each of some roundings.
constexpr int kTieUnits = 12;  // as a power of two

}  // namespace

std::vector<State> start_of(const Scenario& scenario) {
  std::vector<State> start;
  for (const Ball& ball : scenario.balls) {
    start.push_back({widened(ball.position), widened(ball.velocity), widened(ball.spin)});
  }
  return start;
}

/// A ball that falls by the scene's size is as fast as √(2 g L).
Scale scale_of(const Scenario& scenario) {
  double length = 0.0;
  double speed = 0.0;
  for (const Ball& ball : scenario.balls) {
    length = std::max(length, ball.position.cwiseAbs().maxCoeff() + ball.radius);
    speed = std::max(speed, ball.velocity.norm());
  }
  for (const Wall& wall : scenario.walls) length = std::max(length, std::abs(wall.offset));
  if (length == 0.0) length = 1.0;
  speed = std::max(speed, std::sqrt(2.0 * scenario.effects.gravity.value_or(Vec3::Zero()).norm() * length));
  return {length, speed > 0.0 ? speed : length / scenario.duration_s};
}

bool Run::Event::operator<(const Event& other) const {
  const auto key = [](const Event& e) {
    return std::tie(e.time_s, e.kind, e.ball, e.partner, e.piece, e.partner_piece);
  };
  return key(*this) < key(other);
}

Run::Run(const Scenario& scenario, std::vector<State> start, const Accuracy& accuracy, const Real& end_s,
         std::int64_t most_work)
    : scenario_(scenario),
      accuracy_(accuracy),
      scale_(scale_of(scenario)),
      end_s_(end_s),
      most_work_(most_work),
      tie_s_(ldexp(Real(scenario.duration_s), kTieUnits - accuracy.bits)),
      pieces_(start.size()),
      piece_numbers_(start.size(), 0),
      last_impact_s_(start.size(), Real(-2) * tie_s_),
      known_until_s_(end_s) {
  for (const State& state : start) spins_.push_back(state.spin);
  for (std::size_t i = 0; i < start.size(); ++i) begin_piece(i, 0, start[i].x, start[i].v);
  for (std::size_t i = 0; i < start.size() && within_budget(0); ++i) predict(i, 0);
}

bool Run::within_budget(const Real& time_s) {
  if (work_ <= most_work_) return true;
  stop(time_s, fmt::format("its budget of computation is spent, after {} impacts", impact_count_));
  return false;
}

bool Run::movable(std::size_t ball) const {
  return std::isfinite(scenario_.balls[ball].mass);
}

void Run::begin_piece(std::size_t ball, const Real& time_s, const Vector& x, const Vector& v) {
  spins_[ball] = rounded_to(spins_[ball], accuracy_.bits);
  const Flow flow = Flow::of(scenario_.balls[ball], scenario_.effects, spins_[ball]);
  pieces_[ball] = Piece(flow, rounded_to(x, accuracy_.bits), rounded_to(v, accuracy_.bits), time_s, end_s_,
                        accuracy_, scale_);
  ++piece_numbers_[ball];
  const std::int64_t order = accuracy_.order;
  work_ += flow.quadratic != 0 ? 4 * order * order : 12 * order;
}

/// What happens next to a ball whose piece has just begun. All its earlier events are void.
void Run::predict(std::size_t ball, const Real& from_s) {
  const auto self = static_cast<std::uint32_t>(ball);
  const Piece& piece = pieces_[ball];
  if (piece.end_s() < end_s_) {
    events_.insert({piece.end_s(), Kind::next_piece, self, self, Found::nothing, piece_numbers_[ball], 0});
  }
  for (std::size_t w = 0; w < scenario_.walls.size(); ++w) {
    const WallGap gap(piece, scenario_.balls[ball].radius, scenario_.walls[w], accuracy_.bits);
    const FirstContact contact = first_contact(gap, from_s, piece.end_s(), work_);
    if (contact.found == Found::nothing) continue;
    events_.insert({contact.time_s, Kind::wall, self, static_cast<std::uint32_t>(w), contact.found,
                    piece_numbers_[ball], 0});
  }
  if (!scenario_.effects.collisions) return;
  for (std::size_t other = 0; other < pieces_.size(); ++other) {
    // At the start every pair is looked at once, when both have a piece.
    const bool looked_at = from_s == 0 && piece_numbers_[other] == 1 && piece_numbers_[ball] == 1;
    if (other != ball && !(looked_at && other < ball)) {
      predict_pair(std::min(ball, other), std::max(ball, other), from_s);
    }
  }
}

void Run::predict_pair(std::size_t a, std::size_t b, const Real& from_s) {
  const double radius_a = scenario_.balls[a].radius;
  const double radius_b = scenario_.balls[b].radius;
  const double reach = pieces_[a].reach_m() + pieces_[b].reach_m() + radius_a + radius_b;
  ++work_;
  // Neither leaves the sphere round its piece; 2^-40 is above any rounding here.
  if ((pieces_[a].around_m() - pieces_[b].around_m()).norm() > reach * (1.0 + 0x1p-40)) return;
  const Real until_s = std::min(pieces_[a].end_s(), pieces_[b].end_s());
  const PairGap gap(pieces_[a], radius_a, pieces_[b], radius_b, accuracy_.bits);
  const FirstContact contact = first_contact(gap, from_s, until_s, work_);
  if (contact.found == Found::nothing) return;
  events_.insert({contact.time_s, Kind::pair, static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                  contact.found, piece_numbers_[a], piece_numbers_[b]});
}

bool Run::is_void(const Event& event) const {
  if (event.piece != piece_numbers_[event.ball]) return true;
  return event.kind == Kind::pair && event.partner_piece != piece_numbers_[event.partner];
}

bool Run::follow(const Real& time_s) {
  while (!events_.empty() && events_.begin()->time_s <= time_s && limit_.empty()) {
    const Event event = *events_.begin();
    events_.erase(events_.begin());
    if (!is_void(event)) carry_out(event);
    within_budget(event.time_s);
  }
  return time_s <= end_s_ && (limit_.empty() || time_s < known_until_s_);
}

State Run::at(std::size_t ball, const Real& time_s) const {
  const Kinematics now = pieces_[ball].at(time_s);
  return {now.x, now.v, spins_[ball]};
}

void Run::stop(const Real& time_s, std::string limit) {
  if (!limit_.empty()) return;
  known_until_s_ = time_s;
  limit_ = std::move(limit);
}

std::string Run::described(const Event& event) const {
  return event.kind == Kind::wall ? fmt::format("ball {} and wall {}", event.ball, event.partner)
                                  : fmt::format("balls {} and {}", event.ball, event.partner);
}

void Run::carry_out(const Event& event) {
  if (event.kind == Kind::next_piece) {
    const Kinematics now = pieces_[event.ball].at_end();
    begin_piece(event.ball, event.time_s, now.x, now.v);
    predict(event.ball, event.time_s);
  } else if (event.found == Found::unresolved) {
    stop(event.time_s,
         fmt::format("{} touch so gently that they rest on each other or graze", described(event)));
  } else if (!movable(event.ball) && (event.kind == Kind::wall || !movable(event.partner))) {
    stop(event.time_s, fmt::format("{} meet, and neither can be moved", described(event)));
  } else if (!alone(event)) {
    stop(event.time_s, fmt::format("{} meet at the moment of another impact of one of them, and what follows "
                                   "depends on the order",
                                   described(event)));
  } else {
    impact(event);
  }
}

bool Run::alone(const Event& event) {
  std::vector<std::uint32_t> balls;
  const auto add = [&](const Event& e) {
    balls.push_back(e.ball);
    if (e.kind == Kind::pair) balls.push_back(e.partner);
  };
  add(event);
  // One of these balls may have met another just now.
  bool shares = std::any_of(balls.begin(), balls.end(),
                            [&](std::uint32_t i) { return event.time_s - last_impact_s_[i] <= tie_s_; });
  std::size_t impacts = shares ? 2 : 1;
  for (const Event& other : events_) {
    if (other.time_s - event.time_s > tie_s_) break;
    if (other.kind == Kind::next_piece || other.found != Found::impact || is_void(other)) continue;
    add(other);
    ++impacts;
  }
  std::sort(balls.begin(), balls.end());
  const auto twice = std::unique(balls.begin(), balls.end());
  shares = shares || twice != balls.end();
  balls.erase(twice, balls.end());
  const bool told = event.time_s <= tied_until_s_ && !shares;
  if (impacts > 1 && !told && ties_.size() < Solution::kMostTiesTold) {
    ties_.push_back({static_cast<double>(event.time_s), balls, shares});
  }
  if (impacts > 1) tied_until_s_ = event.time_s + tie_s_;
  return !shares;
}

void Run::impact(const Event& event) {
  last_impact_s_[event.ball] = event.time_s;
  if (event.kind == Kind::wall) {
    meet_wall(event);
    predict(event.ball, event.time_s);
    return;
  }
  last_impact_s_[event.partner] = event.time_s;
  meet_ball(event);
  predict(event.ball, event.time_s);
  predict(event.partner, event.time_s);
}

void Run::meet_wall(const Event& event) {
  const Ball& ball = scenario_.balls[event.ball];
  const Kinematics now = pieces_[event.ball].at(event.time_s);
  const Vector normal = widened(scenario_.walls[event.partner].normal).normalized();
  Side wall;
  Side side = Side::of(ball, now.v, spins_[event.ball]);
  const Vector push = strike(scenario_.wall_contact, normal, wall, side);
  spins_[event.ball] = side.spin;
  begin_piece(event.ball, event.time_s, now.x, side.v);
  book(event, push, now.x - normal * Real(ball.radius));
}

void Run::meet_ball(const Event& event) {
  const Ball& ball_a = scenario_.balls[event.ball];
  const Kinematics now_a = pieces_[event.ball].at(event.time_s);
  const Kinematics now_b = pieces_[event.partner].at(event.time_s);
  const Vector normal = (now_b.x - now_a.x).normalized();
  Side a = Side::of(ball_a, now_a.v, spins_[event.ball]);
  Side b = Side::of(scenario_.balls[event.partner], now_b.v, spins_[event.partner]);
  const Vector push = strike(scenario_.ball_contact, normal, a, b);
  spins_[event.ball] = a.spin;
  spins_[event.partner] = b.spin;
  begin_piece(event.ball, event.time_s, now_a.x, a.v);
  begin_piece(event.partner, event.time_s, now_b.x, b.v);
  // The push of an immovable ball comes from outside.
  Vector external = Vector::Zero();
  if (!movable(event.ball)) external = push;
  if (!movable(event.partner)) external = -push;
  book(event, external, now_a.x + normal * Real(ball_a.radius));
}

void Run::book(const Event& event, const Vector& external_Ns, const Vector& contact_m) {
  ++impact_count_;
  external_Ns_ += external_Ns;
  external_Nms_ += contact_m.cross(external_Ns);
  if (impacts_.size() < Solution::kMostImpactsTold) {
    impacts_.push_back(
        {static_cast<double>(event.time_s), event.ball, event.partner, event.kind == Kind::wall});
  }
}

Tally Run::tally() const {
  Tally tally;
  tally.impacts = impact_count_;
  tally.external_impulse = rounded(external_Ns_);
  tally.external_angular_impulse = rounded(external_Nms_);
  return tally;
}

}  // namespace carom::converged
