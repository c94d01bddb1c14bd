#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// What a border does at a vertex.
enum class BorderTurn {
  none,      ///< not on the border
  corner,    ///< turns sharply, or between straight parts; or the border passes twice
  straight,  ///< goes straight on
  curved
};

/// (V,) loops: all of the map's; z: (V,).
std::vector<BorderTurn> border_turns(const std::vector<BoundaryLoop>& loops, const ComplexVector& z);

/// Vertices that slide along the border, which is a curve gamma through its vertices: cubic Hermite pieces over their
/// chord lengths s, with a continuous tangent but at corners; straight parts stay exactly straight. A coordinate x of
/// such a vertex is (s, 0), that of any other its position, so that what is linear in x slides.
class SlidingBorder {
 public:
  /// loops: closed; z: (V,), where the curves are; slides: (V,), no corners.
  static SlidingBorder along(const std::vector<BoundaryLoop>& loops, const ComplexVector& z,
                             const std::vector<char>& slides);

  bool empty() const { return sliders_.empty(); }
  /// x of the map in which the sliding vertices lie where the curves were laid. z: (V,), like all below.
  ComplexVector coordinates(ComplexVector z) const;
  /// The map at x.
  ComplexVector map_at(ComplexVector x) const;
  /// Makes a small displacement of x one of the map: gamma'(s) ds.
  void push_forward(const ComplexVector& x, ComplexVector& displacement) const;
  /// Makes a gradient in the map one in x, the adjoint: Re(conj(gamma'(s)) g).
  void pull_back(const ComplexVector& x, ComplexVector& gradient) const;

 private:
  struct Edge {
    Complex from;
    Complex to;
    Complex leaving;   ///< tangent at `from`, of length 1
    Complex arriving;  ///< at `to`
  };
  struct Curve {
    std::vector<Edge> edges;
    std::vector<double> at;  ///< s at which each edge begins, and the end
  };
  struct Slider {
    int vertex;
    int curve;
    double start;  ///< s
  };
  struct Place {
    const Edge& edge;
    double length;
    double t;  ///< from 0 to 1
  };

  Place place(const Slider& slider, const ComplexVector& x) const;
  Complex tangent(const Slider& slider, const ComplexVector& x) const;

  std::vector<Curve> curves_;
  std::vector<Slider> sliders_;
};

}  // namespace spectral_conformal
