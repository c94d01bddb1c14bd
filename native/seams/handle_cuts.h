#pragma once

#include <functional>
#include <vector>

#include "mesh/charts.h"
#include "seams/seam_graph.h"

namespace spectral_conformal {

/// Closed curves, as unordered edges, that generate all closed curves on a connected surface, except those around its
/// boundary loops and cuts; short ones first. By the tree-cotree decomposition with shortest paths to the vertex `base`
/// (Eppstein 2003; Erickson and Whittlesey 2005, "Greedy optimal homotopy and homology generators"). Omits edges that
/// are already cut.
std::vector<std::vector<int>> generator_loops(const SeamGraph& graph, int n_faces, int base);

/// Cuts that open all handles of a mesh of one chart: non-separating loops, cheap ones first. Empty for any other mesh.
/// `mirror_edge(edge)` returns the image of an edge under a symmetry of the mesh, or -1. Loops include their images if
/// together these do not separate the mesh. Throws InvalidMesh as build_charts does.
std::vector<std::vector<int>> handle_cuts(const PolygonMesh& mesh, const SeamGraph& graph,
                                          const std::function<int(int edge)>& mirror_edge);

}  // namespace spectral_conformal
