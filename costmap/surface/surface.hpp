#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <ios>
#include <iosfwd>
#include <string>
#include <vector>

#include <octomap/AbstractOcTree.h>
#include <octomap/OcTreeBaseImpl.h>
#include <octomap/OcTreeDataNode.h>
#include <octomap/OcTreeKey.h>

#include <talus/maps/maps.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::costmap {

/// Hazards of a cell: reasons other than the soil for which a cell is refused (may not be entered) or its
/// category is lowered. A value is a set of bits.
enum class Hazard : std::uint8_t {
  None = 0,
  Unknown = 1,    ///< no elevation, no terrain class, no measurable shape, or no data in a cost layer
  Slope = 2,      ///< the gradient exceeds the limit for every heading
  Step = 4,       ///< a step or the relief under the wheels exceeds the ground clearance
  Roughness = 8,  ///< the roughness exceeds the clearance of the belly
  Rocks = 16,     ///< the probability of a rock too large to cross is too high
  KeepOut = 32,   ///< the cell lies in a keep-out polygon, or has an infinite cost in a layer
  Obstacle = 64,  ///< the terrain class has no soil, or the ground was declared impassable
  Near = 128,     ///< the cell is closer than half the rover's width to a cell that the rover must avoid
};

constexpr Hazard operator|(Hazard a, Hazard b) noexcept {
  return static_cast<Hazard>(static_cast<std::uint8_t>(a) | static_cast<std::uint8_t>(b));
}
constexpr Hazard& operator|=(Hazard& a, Hazard b) noexcept {
  return a = a | b;
}

/// Returns true if the set `set` contains the hazard `one`.
constexpr bool has(Hazard set, Hazard one) noexcept {
  return (static_cast<std::uint8_t>(set) & static_cast<std::uint8_t>(one)) != 0;
}

/// Estimate of one cell, stored in the octree. It contains the strength of the ground, from the prior of the
/// terrain class and from wheel evidence, and the category of the cell, which is the worst over all headings.
struct CellBelief {
  float pull_mean = 0.0F;     ///< mean drawbar pull over load DP/W at slip 0.5 [-]
  float pull_std = 0.0F;      ///< standard deviation of pull_mean [-]
  float sinkage_mean = 0.0F;  ///< mean sinkage over wheel radius z/r at slip 0.5 [-]
  float sinkage_std = 0.0F;   ///< standard deviation of sinkage_mean [-]
  /// Number of pull readings in the block of the cell, each weighted by its certainty [-]; 0: no evidence. A
  /// block is a square of cells that stores its evidence together.
  float evidence = 0.0F;
  float evidence_pull = 0.0F;      ///< DP/W of the weakest part of the readings [-]
  float evidence_sinkage = 0.0F;   ///< z/r of the deepest part of the readings [-]; 0: not measured
  std::uint32_t updated_s = 0;     ///< telemetry time of the newest reading, rounded down [s]
  std::uint8_t terrain_class = 0;  ///< number of the terrain class in the class raster; 0 without a raster
  std::uint8_t category = 3;       ///< terramech::Category as a number: safe, marginal, dangerous, unknown
  std::uint8_t confidence = 0;     ///< probability of the category in steps of 1/16; 16 = certain
  Hazard hazards = Hazard::None;   ///< set of hazards of the cell

  friend bool operator==(const CellBelief&, const CellBelief&) = default;
};

/// Octree keys of the cells of a map. The keys x and y are cell indices from the centre of the grid; the key
/// z is the height above a base elevation in units of the cell size. Tree coordinates are map coordinates
/// minus origin().
class SurfaceKeys {
 public:
  /// Makes the keys of a grid; base_elevation_m [m] is the elevation of z = 0 in tree coordinates. Throws
  /// std::invalid_argument for more than 65536 cells on a side, the limit of OctoMap's keys.
  SurfaceKeys(const maps::Grid& grid, double base_elevation_m);

  /// Returns the key of a cell at an elevation [m]; elevations outside the tree are clamped.
  octomap::OcTreeKey key(maps::Cell cell, double elevation_m) const noexcept;

  double baseElevation_m() const noexcept { return base_elevation_m_; }
  const maps::Grid& grid() const noexcept { return grid_; }

  /// Returns the map coordinates of the tree's origin.
  maps::Point origin() const noexcept;

 private:
  maps::Grid grid_;
  double base_elevation_m_;
};

/// Lowest and highest height key of the surface over square blocks of cells with sides 1, 2, 4, ... cells (a
/// pyramid), for finding the octree cubes through which the surface passes.
class SurfacePyramid {
 public:
  /// Lowest and highest height key of a block; low > high for a block without elevations.
  struct Range {
    std::uint16_t low = 0xffff;
    std::uint16_t high = 0;
    bool empty() const noexcept { return low > high; }
    /// Returns true if the range overlaps the height keys from `from` to from + count - 1.
    bool meets(unsigned from, unsigned count) const noexcept { return low < from + count && high >= from; }
  };

  SurfacePyramid(const maps::Raster<float>& elevation_m, const SurfaceKeys& keys);

  /// Returns the range of the block of 2^level cells per side that starts at these keys, which are multiples
  /// of 2^level.
  Range range(unsigned level, unsigned x_key, unsigned y_key) const noexcept;

 private:
  struct Level {
    unsigned first_x, first_y, width, height;
    std::vector<Range> ranges;
  };
  std::vector<Level> levels_;
};

/// Limits of terrain shape and rocks for a rover, independent of the soil. Plain data; of() computes the
/// limits of a rover.
struct HazardLimits {
  /// Gradient (rise over run) above which no heading satisfies the pitch and roll limits [-].
  double max_gradient = 0.36;
  double max_step_m = 0.1;  ///< greatest allowed height step and relief within one wheelbase
  /// Greatest allowed rms deviation of the ground from the fitted plane within one wheelbase.
  double max_roughness_m = 0.05;
  /// Diameter of the smallest rock that the rover can neither straddle nor climb.
  double rock_diameter_m = 0.2;
  double rock_area_m2 = 1.0;  ///< area under the rover that must be free of such rocks
  /// Greatest accepted probability of at least one such rock in the area rock_area_m2 [-].
  double max_rock_probability = 0.5;
  /// Span within which a height difference counts fully as a step; see reliefShare().
  double wheelbase_m = 1.0;
  /// Greatest horizontal distance of two elevations that form a step. Adjacent cells form steps at any cell
  /// size.
  double wheel_diameter_m = 0.0;
  /// Clearance of the rover's centre from cells that the whole rover must avoid (kKeptClearOf).
  double inflation_m = 0.0;

  /// Returns the limits of a rover: step and relief up to the ground clearance, rocks up to twice the
  /// clearance, roughness up to a third of the clearance, inflation by half the rover's width.
  static HazardLimits of(const terramech::Rover& rover);
  /// Returns limits that no shape and no rock exceeds, for a point that only its cost restricts.
  static HazardLimits ofPoint();
};

/// Returns the share of a height difference that counts as a step: min(1, wheelbase_m / span_m). span_m [m]
/// is the width of the footprint or the distance of the two cells. A height difference over a span longer
/// than the wheelbase is partly curvature of the ground, not an edge (ours, not from the literature).
double reliefShare(const HazardLimits& limits, double span_m);

/// Terrain shape at a cell, from maps::TerrainMetrics: gradients of the fitted plane eastward and northward
/// (rise over run), rms and range of the residuals from the plane, and greatest height step.
struct GroundShape {
  float dz_dx = 0.0F;
  float dz_dy = 0.0F;
  float roughness_m = 0.0F;
  float relief_m = 0.0F;
  float step_m = 0.0F;
};

/// Horizontal spans over which a terrain shape was measured.
struct ShapeSpans {
  double footprint_m = 0.0;  ///< diameter of the footprint, i.e. of the disc of cells under the rover
  double cell_m = 0.0;       ///< distance of adjacent cells
};

/// Finds the hazards of terrain shapes that were all measured over the same spans.
class ShapeJudge {
 public:
  ShapeJudge(const HazardLimits& limits, const ShapeSpans& spans);

  /// Returns the set of Slope, Step and Roughness hazards of a shape; Unknown if a gradient is NaN.
  Hazard operator()(const GroundShape& shape) const noexcept;

 private:
  float gradient_squared_, relief_m_, step_m_, roughness_m_;
};

/// Hazards of cells that the whole width of the rover must avoid.
inline constexpr Hazard kKeptClearOf = Hazard::KeepOut | Hazard::Obstacle | Hazard::Rocks | Hazard::Unknown;

/// Adds Hazard::Near to all cells that have a point closer than limits.inflation_m to a cell with a hazard of
/// the set `spreading`. If the set contains Unknown, cells closer than limits.inflation_m to the border of
/// the map are marked, too.
void inflate(maps::Raster<Hazard>& hazards, const HazardLimits& limits, Hazard spreading = kKeptClearOf);
/// Adds Hazard::Near like the function above, but to cells of `box` only, which must lie inside the map.
/// Inside the box, the result equals that of inflate() on all cells.
void inflate(maps::Raster<Hazard>& hazards, const HazardLimits& limits, Hazard spreading,
             const maps::CellBox& box);
/// Returns the greatest column or row offset between a cell with a spreading hazard and the cells marked for
/// it.
int inflationReach(const HazardLimits& limits, double resolution_m);

/// Node of the traversability octree, with the estimate of the ground in its cube.
class TraversabilityNode : public octomap::OcTreeDataNode<CellBelief> {
 public:
  TraversabilityNode() : OcTreeDataNode(CellBelief{}) {}
  TraversabilityNode(const TraversabilityNode& other);
  TraversabilityNode& operator=(const TraversabilityNode&) = delete;

  /// Writes the estimate as 36 bytes, little-endian, in the order of CellBelief's fields.
  std::ostream& writeData(std::ostream& stream) const;
  /// Reads the estimate; sets failbit if bytes are missing or a value is invalid.
  std::istream& readData(std::istream& stream);

  const CellBelief& belief() const noexcept { return value; }
  CellBelief& belief() noexcept { return value; }

  /// Frees the array of child pointers; all children must have been deleted.
  void forgetChildren() noexcept;
};

/// OctoMap octree of type "TraversabilityTree". A leaf is a cube of ground with one estimate, which applies
/// to all ground in the cube; the elevation map gives the position of the ground inside the cube. A node
/// whose existing children are equal leaves is pruned (becomes a leaf itself), even if some children do not
/// exist. Not thread-safe during changes.
class TraversabilityTree : public octomap::OcTreeBaseImpl<TraversabilityNode, octomap::AbstractOcTree> {
 public:
  /// Makes an empty tree whose smallest cubes have sides of resolution_m [m].
  explicit TraversabilityTree(double resolution_m);

  TraversabilityTree* create() const override { return new TraversabilityTree(resolution); }
  std::string getTreeType() const override { return "TraversabilityTree"; }

  /// Returns the estimate of the leaf that contains a key; null if there is no leaf.
  const CellBelief* find(const octomap::OcTreeKey& key) const;
  /// Returns the estimate at a key for modification; creates the leaf, and splits a pruned cube if needed. A
  /// depth below 16 creates a leaf for a cube of 2^(16 - depth) cells per side; the tree must have no finer
  /// nodes there.
  CellBelief& at(const octomap::OcTreeKey& key, unsigned depth = 16);

  /// Returns the root node; creates it if absent.
  TraversabilityNode* makeRoot();

  /// Writes a preamble with the version of the node format, then the nodes.
  std::ostream& writeData(std::ostream& stream) const override;
  /// Reads the preamble and the nodes from a stream behind the file header. Sets failbit and leaves the tree
  /// empty if the stream is truncated or of another format.
  std::istream& readData(std::istream& stream) override;

  bool isNodeCollapsible(const TraversabilityNode* node) const override;
  bool pruneNode(TraversabilityNode* node) override;
  /// Prunes all nodes with equal children, from the leaves upwards.
  void prune() override;

 private:
  bool readNode(TraversabilityNode* node, std::istream& stream, unsigned depth);
  void pruneBelow(TraversabilityNode* node);

  struct Registration {
    Registration();
    void touch() const noexcept {}
  };
  static const Registration registration_;
};

/// Writes the file header and the nodes of a tree; equal trees give equal bytes.
void writeTree(const TraversabilityTree& tree, std::ostream& stream);

/// Writes the bytes of writeTree() node by node in depth-first order, without a tree in memory.
class TreeWriter {
 public:
  /// Writes the file header; the stream must be seekable.
  TreeWriter(std::ostream& stream, double resolution_m);
  /// Writes a node; bit i of `children` is 1 if the child i follows.
  void node(const CellBelief& belief, std::uint8_t children);
  /// Writes the number of nodes into the header. Must be called after the last node.
  void finish();

 private:
  std::ostream& stream_;
  std::streampos size_at_;
  std::size_t nodes_ = 0;
};

/// Returns the tree that writeTree() wrote to a stream, and leaves the stream after the last node. Throws
/// InputError for a stream that is truncated, damaged or of another tree type; the error names the stream
/// `name`.
TraversabilityTree readTree(std::istream& stream, const std::string& name);

/// A leaf of the tree: a cube of ground with one estimate, given by its lowest keys and its side length in
/// cells.
struct TreeLeaf {
  octomap::OcTreeKey low;
  unsigned side = 1;
  CellBelief belief;
};

/// Reads the output of writeTree() and calls `visit` for each leaf, without a tree in memory. Throws
/// InputError in the cases of readTree().
void readLeaves(std::istream& stream, const std::string& name,
                const std::function<void(const TreeLeaf&)>& visit);

}  // namespace talus::costmap
