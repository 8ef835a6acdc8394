// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mesh/triangle_mesh.h"

// Where a refined map spends its Gaussians: Yguel 2009, sec. 6, "large flat clusters remain (in particular on the
// ground and on the walls) while a lot of detail clusters are added at poles and corners".
namespace gaussmap::benchmark {

/// The kind of the surface around a point.
enum class SurfaceKind {
  Flat,   ///< all surface near the point lies in one plane: ground and walls
  Detail  ///< the point is near an edge, a corner, or a thin or curved object
};

struct SurfaceKindOptions {
  double radius = 0.5;      ///< "near" [m]
  double tolerance = 0.02;  ///< largest distance of a nearby triangle from the plane of a flat point [m]
  double angle_deg = 10.0;  ///< largest angle between a nearby triangle and this plane [degree]
};

/// Returns the kind of the surface at the foot of each point, the nearest point of the mesh. A foot is flat if every
/// triangle within `radius` of it is within the tolerances of the plane of its own triangle. A triangle without area is
/// never within them. Throws std::invalid_argument like MeshDistance.
std::vector<SurfaceKind> surfaceKinds(const std::vector<Vector<3>>& points, const TriangleMesh& mesh,
                                      const SurfaceKindOptions& options = {});

/// The Gaussians of one scale on one kind of surface.
struct SurfaceBudget {
  std::size_t gaussians = 0;  ///< Gaussians of the scale that mostly represent this kind
  std::size_t cells = 0;      ///< cells of the scale that contain this kind
  double area = 0.0;  ///< of the surface [m^2]: number of finest cells of this kind times the square of their side

  double perCell() const { return cells > 0 ? double(gaussians) / double(cells) : 0.0; }
  double perHundredSquareMetres() const { return area > 0.0 ? 100.0 * double(gaussians) / area : 0.0; }
};

struct BudgetBySurface {
  SurfaceBudget flat, detail;

  /// The share of the Gaussians, and of the surface, that is on edges, corners, and thin or curved objects: 0 to 1.
  double detailShareOfGaussians() const { return share(double(detail.gaussians), double(flat.gaussians)); }
  double detailShareOfArea() const { return share(detail.area, flat.area); }

 private:
  static double share(double a, double b) { return a + b > 0.0 ? a / (a + b) : 0.0; }
};

/// Counts the Gaussians of a coarse scale by the kind of the surface that they represent. Each finest Gaussian under a
/// Gaussian of the scale has the kind of surfaceKinds() at its mean; the Gaussian has the kind of most of them, flat if
/// both are equal. `mesh`: the surface from which the map was made [m, map frame]. Throws std::out_of_range if the map
/// does not have the scale, and std::invalid_argument if it is compressed, or like MeshDistance.
BudgetBySurface budgetBySurface(const GaussianMap<3>& map, int scale, const TriangleMesh& mesh,
                                const SurfaceKindOptions& options = {});

}  // namespace gaussmap::benchmark
