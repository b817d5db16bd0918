// The picture of a motion as data: the drawn items, and the straight-line program that computes their places from a row
// of the run.
//
// The viewer computes positions from coordinates that are interpolated between rows, so a rolling wheel rolls at every
// moment, and the page contains formulas instead of poses. Lengths are those of the model; vectors and axes are in the
// observer's axes.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "mechanics/mechanics.h"
#include "tape/tape.h"

namespace anholon {

struct SceneItem {
  std::string kind;  // body, point, line, vector, trace
  std::string name, of, what, color;
  std::string shape;  // of a body
  std::vector<double> sizes;
  std::vector<std::array<std::size_t, 3>> places;  // roots of the tape
  std::optional<std::array<std::size_t, 9>> axes;  // x, y, z axis of the body
  std::optional<std::array<std::size_t, 3>> vector;
};

struct Scene {
  Tape tape;
  std::vector<double> parameters;
  std::vector<SceneItem> items;
  std::optional<std::array<std::size_t, 3>> camera, target;
  std::optional<double> floor;  // height of a plane z = const
  bool no_grid = false;         // the model wants neither floor nor grid
  std::array<double, 3> up{0, 0, 1};
  bool flat = false;  // everything stays in a plane z = const
  std::string follow;
};

// The default without [view]: bodies, points, tensions; the velocity of every mass centre, and the reaction on every
// body that has one. `contacts`: contacts act on bodies, so their forces are reactions, too.
Scene scene(const Mechanics& mechanics, bool contacts = false);

// Returns the index of the column of a symbol; -1: the time; nullopt: no column.
using ColumnOf = std::function<std::optional<int>(const Node& symbol)>;
// The columns of the scene's inputs, without the time.
std::vector<int> columns_of(const Scene& scene, const Graph& graph, const ColumnOf& column);
// Writes the format of the viewer (viewer/CONTRACT.md); `observer` writes the observer, or null if there is none.
void write_scene(JsonWriter& json, const Scene& scene, const Graph& graph, const ColumnOf& column,
                 const std::function<void(JsonWriter&)>& observer);

}  // namespace anholon
