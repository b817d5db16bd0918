#include "kernel/state_map.h"

#include "base/assert.h"

namespace anholon {

static Tape compiled(const Column& es, const QuasiVelocities& q) {
  return compile(es, std::vector<int>(es.size(), 0), false, q.system.rates,
                 static_cast<std::uint32_t>(q.system.coordinates));
}

StateMap::StateMap(const QuasiVelocities& q)
    : coordinates_(q.system.coordinates), states_(q.system.size() - q.system.coordinates - q.count),
      velocities_(q.count), to_own_(compiled(q.of_state, q)), to_motion_(compiled(q.velocities, q)),
      of_own_(inputs(to_own_, q)), of_motion_(inputs(to_motion_, q)) {
  // The series from which velocities are computed are in both tapes; p is not needed for computing p.
  std::erase_if(of_own_, [&](const Input& in) { return in.from == From::other && in.index >= states_; });
}

std::vector<StateMap::Input> StateMap::inputs(const Tape& tape, const QuasiVelocities& q) {
  std::vector<Input> list;
  for (const anholon::Input& in : tape.inputs) {
    const Node& n = q.system.model->graph->node(in.symbol);
    ANHOLON_ASSERT(n.kind == Kind::time || n.kind == Kind::state || (n.kind == Kind::jet && n.order <= 1));
    list.push_back({n.kind == Kind::time    ? From::time
                    : n.kind == Kind::state ? From::other
                    : n.order == 0          ? From::coordinate
                                            : From::velocity,
                    in.slot, n.index});
  }
  return list;
}

void StateReader::own(long double t, const Numbers& state, Numbers& own) {
  const std::size_t n = map_->coordinates_;
  ANHOLON_ASSERT(state.size() == 2 * n + map_->states_);
  using From = StateMap::From;
  for (const StateMap::Input& in : map_->of_own_) {
    to_own_.series(in.slot)[0] = in.from == From::time    ? t
                                 : in.from == From::other ? state[2 * n + in.index]
                                                          : state[2 * in.index + (in.from == From::velocity)];
  }
  to_own_.evaluate();
  own.resize(map_->own_size());
  for (std::size_t a = 0; a < n; ++a) own[a] = state[2 * a];
  for (std::size_t i = 0; i < map_->states_; ++i) own[n + i] = state[2 * n + i];
  for (std::size_t i = 0; i < map_->velocities_; ++i) own[n + map_->states_ + i] = to_own_.value(i);
}

void StateReader::motion(long double t, const Numbers& own, Numbers& state) {
  const std::size_t n = map_->coordinates_;
  ANHOLON_ASSERT(own.size() == map_->own_size());
  using From = StateMap::From;
  for (const StateMap::Input& in : map_->of_motion_) {
    to_motion_.series(in.slot)[0] = in.from == From::time ? t : own[in.from == From::other ? n + in.index : in.index];
  }
  to_motion_.evaluate();
  state.resize(2 * n + map_->states_);
  for (std::size_t a = 0; a < n; ++a) state[2 * a] = own[a], state[2 * a + 1] = to_motion_.value(a);
  for (std::size_t i = 0; i < map_->states_; ++i) state[2 * n + i] = own[n + i];
}

void StateReaders::load(int lane, long double t, const Numbers& own) {
  ANHOLON_ASSERT(own.size() == map_->own_size());
  using From = StateMap::From;
  for (const StateMap::Input& in : map_->of_motion_)
    machine_.set(in.slot, lane,
                 in.from == From::time ? t : own[in.from == From::other ? map_->coordinates_ + in.index : in.index]);
}

void StateReaders::motion(int lane, const Numbers& own, Numbers& state) const {
  const std::size_t n = map_->coordinates_;
  state.resize(2 * n + map_->states_);
  for (std::size_t a = 0; a < n; ++a) state[2 * a] = own[a], state[2 * a + 1] = machine_.value(a, lane);
  for (std::size_t i = 0; i < map_->states_; ++i) state[2 * n + i] = own[n + i];
}

}  // namespace anholon
