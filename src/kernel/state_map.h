// A map between states. A kernel may have other unknowns than the motion it serves: coordinates, the model's states and
// quasi-velocities p, all of first order (lowering/quasi_velocities.h), while the motion's state is q, q', z. The map
// converts one state to the other, in the width of the motion's state.
#pragma once
#include <optional>

#include "kernel/pairs.h"
#include "lowering/quasi_velocities.h"
#include "tape/tape.h"

namespace anholon {

class StateMap {
 public:
  explicit StateMap(const QuasiVelocities& q);

  std::size_t coordinates() const { return coordinates_; }
  std::size_t velocities() const { return velocities_; }
  std::size_t own_size() const { return coordinates_ + states_ + velocities_; }
  // The kernel's unknown that equals the motion's unknown j, of `count`; nullopt for multipliers.
  std::optional<std::size_t> own(std::size_t j, std::size_t count) const {
    if (j < coordinates_) return j;
    return j + states_ < count ? std::nullopt : std::optional<std::size_t>(coordinates_ + j + states_ - count);
  }

 private:
  friend class StateReader;
  friend class StateReaders;
  enum class From : std::uint8_t { time, coordinate, velocity, other };
  struct Input {
    From from;
    std::uint32_t slot;
    std::size_t index;  // other: index of a state among the kernel's unknowns, z before p
  };
  static std::vector<Input> inputs(const Tape& tape, const QuasiVelocities& q);

  std::size_t coordinates_, states_, velocities_;
  Tape to_own_, to_motion_;
  std::vector<Input> of_own_, of_motion_;
};

// The workspace of one motion.
class StateReader {
 public:
  using Numbers = std::vector<long double>;
  StateReader(const StateMap& map, const Numbers& parameters)
      : map_(&map), to_own_(map.to_own_, 0, parameters), to_motion_(map.to_motion_, 0, parameters) {}
  void set_parameters(const Numbers& parameters) {
    to_own_.set_parameters(parameters);
    to_motion_.set_parameters(parameters);
  }
  // Converts the state of the motion (q_a, q_a', one after the other, then z) to that of the kernel (q, z, p).
  void own(long double t, const Numbers& state, Numbers& own);
  void motion(long double t, const Numbers& own, Numbers& state);

 private:
  const StateMap* map_;
  Machine<long double> to_own_, to_motion_;
};

// Maps the kernel's states of several motions side by side to states of the motions, in pairs of doubles.
class StateReaders {
 public:
  using Numbers = StateReader::Numbers;
  StateReaders(const StateMap& map, const Numbers& parameters, int lanes)
      : map_(&map), machine_(map.to_motion_, parameters, lanes) {}
  // Puts a state into a lane; every lane needs one before convert().
  void load(int lane, long double t, const Numbers& own);
  void convert() { machine_.evaluate(); }
  // Reads the state of a lane; `own`: the state that was put in.
  void motion(int lane, const Numbers& own, Numbers& state) const;

 private:
  const StateMap* map_;
  PairMachine machine_;
};

}  // namespace anholon
