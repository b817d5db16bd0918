// Finds where the values of a sweep change, on a grid that is halved at these places only.
//
// The points of the axes bound cells. A cell lies at a border if two neighbours on one of its edges differ: two
// corners, or a corner and a point that the halving of another cell has put on the edge. Such a cell is halved along
// each axis. The places of points are whole numbers, in units of a grid that is 2^g times as fine as the first one in
// generation g.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace anholon {

// The observed data of a point.
struct Sight {
  std::uint32_t kind = 0;  // the kind of the end of its motion
  double value = 0;        // the value of a column
};

class Borders {
 public:
  using Differ = std::function<bool(const Sight&, const Sight&)>;

  // `axes`: the numbers of points of the axes of the first generation. An axis of one point bounds no cell.
  explicit Borders(const std::vector<std::size_t>& axes);
  // Takes the data of the points of the newest generation, in their order; at first those of the whole grid, the
  // last axis fastest.
  void see(const std::vector<Sight>& sights);
  // Begins the next generation: halves the cells at borders. Returns the places of the points that it adds, one point
  // after the other, in ascending order. Throws Failure without a place if the grid is too fine to number its points.
  std::vector<std::int64_t> next(const Differ& differ);

 private:
  using Key = std::uint64_t;  // the number of a point in the whole grid of this generation
  struct Known {
    Key key;
    Sight sight;
  };
  void refine_units();
  void count_keys();
  const Sight* find(Key key) const;
  bool at_border(const std::int64_t* cell, const Differ& differ) const;
  bool differ_along(Key from, Key step, std::int64_t length, const Differ& differ) const;
  void halve(const std::int64_t* cell, std::vector<std::int64_t>& cells, std::vector<Key>& points) const;
  std::vector<std::int64_t> places(Key key) const;

  std::vector<std::size_t> wide_;    // axes with more than one point
  std::vector<std::uint64_t> size_;  // points of each axis in the units of this generation
  std::vector<Key> stride_;
  std::vector<Known> known_;         // by ascending keys
  std::vector<Key> pending_;         // the points of the newest generation
  std::vector<std::int64_t> cells_;  // the least corner of each cell along the wide axes, and its width
};

}  // namespace anholon
