#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <numeric>
#include <set>

#include "meshes.h"
#include "seams/cut_surface.h"
#include "seams/piece_seams.h"

namespace spectral_conformal::test {
namespace {

/// The one piece of a mesh, with its seams. Keeps what PieceSeams refers to.
struct OnePiece : MirroredPieces {
  Mesh mesh;
  std::vector<int> one_chart;

  explicit OnePiece(Mesh given) : MirroredPieces(of(given.view())), mesh(std::move(given)) {
    REQUIRE(pieces.size() == 1);
    one_chart.assign(static_cast<std::size_t>(mesh.n_faces()), 0);
  }
  PieceSeams seams() const { return PieceSeams(pieces[0], 0, mirrors[0], symmetry); }
  std::vector<Chart> charts(const PieceSeams& seams) const {
    PolygonMesh view = pieces[0].view();
    const auto edges = seams.changed({}, {});
    view.seam_edges = edges.data();
    view.n_seam_edges = static_cast<int>(edges.size());
    return build_charts(view).charts;
  }
  /// Whether the images of the edges are among them.
  bool symmetric(const PieceSeams& seams) const {
    std::set<std::array<int, 2>> edges;
    for (const int e : seams.edges()) edges.insert(seams.graph().edges()[e].vertices);
    return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
      const int a = symmetry.vertex[edge[0]], b = symmetry.vertex[edge[1]];
      return edges.count({std::min(a, b), std::max(a, b)}) == 1;
    });
  }
};

/// Bent so that it has no symmetry.
Mesh bent_grid(int n_x, int n_y) {
  Mesh grid = quad_grid(n_x, n_y);
  for (Eigen::Vector3d& p : grid.points) p.z() = 0.01 * p.x() * p.x() * p.y();
  return grid;
}

/// The edges of a path over these vertices.
SeamEdges edges_along(const PieceSeams& seams, std::initializer_list<int> vertices) {
  SeamEdges result;
  for (const int* v = vertices.begin(); v + 1 != vertices.end(); ++v) {
    result.push_back(seams.graph().find_edge(*v, *(v + 1)));
  }
  REQUIRE(std::count(result.begin(), result.end(), -1) == 0);
  return result;
}

}  // namespace

TEST_SUITE_BEGIN("piece_seams");

TEST_CASE("two edge loops run through every vertex of a torus, none through one of a grid") {
  const OnePiece ring(torus(12, 8));
  const PieceSeams seams = ring.seams();
  std::set<std::size_t> sizes;
  for (const std::size_t which : {std::size_t{0}, std::size_t{1}}) {
    const SeamEdges loop = seams.loop_through(5, which, 0, ring.one_chart);
    sizes.insert(loop.size());
    CHECK(std::any_of(loop.begin(), loop.end(), [&](int e) {
      const auto& [a, b] = seams.graph().edges()[e].vertices;
      return a == 5 || b == 5;
    }));
  }
  CHECK((sizes.count(12) + sizes.count(24) > 0 && sizes.count(8) + sizes.count(16) > 0));  // with images
  CHECK(seams.loop_through(5, 2, 0, ring.one_chart).empty());
  const OnePiece grid(bent_grid(4, 4));
  CHECK(grid.seams().loop_through(6, 0, 0, grid.one_chart).empty());
}

TEST_CASE("closed surfaces are opened to disks with or without holes, symmetrically") {
  for (const Mesh& mesh : {sphere(4), torus(12, 8), double_torus()}) {
    const OnePiece piece(mesh);
    PieceSeams seams = piece.seams();
    CHECK_FALSE(seams.open().empty());
    const auto charts = piece.charts(seams);
    REQUIRE(charts.size() == 1);
    CHECK_FALSE(charts[0].boundary_loops.empty());
    CHECK(handle_curves(charts[0]) == 0);
    CHECK(piece.symmetric(seams));
  }
  const OnePiece odd(tetrahedron());
  PieceSeams seams = odd.seams();
  CHECK(seams.open().size() == 1);
  CHECK(odd.charts(seams)[0].boundary_loops.size() == 1);
}

TEST_CASE("a patch that can be unwrapped needs no cut, one whose longest loops are a mirrored pair gets a bridge") {
  const OnePiece disk(spiky_grid(1, 2));
  PieceSeams none = disk.seams();
  CHECK(none.open().empty());
  // A tube along x, closed around z, symmetric in x: its two ends are each other's images.
  Mesh tube;
  for (int i = 0; i < 7; ++i) {
    for (int k = 0; k < 10; ++k)
      tube.points.emplace_back(i - 3, std::cos(k * 0.6283185307), std::sin(k * 0.6283185307));
  }
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 10; ++k)
      tube.add({10 * i + k, 10 * i + 10 + k, 10 * i + 10 + (k + 1) % 10, 10 * i + (k + 1) % 10});
  }
  for (Eigen::Vector3d& p : tube.points) p.y() *= 1.2;
  const OnePiece open(tube);
  REQUIRE(open.symmetry.axis == 0);
  PieceSeams seams = open.seams();
  CHECK(seams.open().size() == 1);
  CHECK(open.charts(seams)[0].boundary_loops.size() == 1);
  CHECK(open.symmetric(seams));
}

TEST_CASE("a cut to a spike comes with its image, and encloses nothing") {
  const OnePiece piece(spiky_grid(2, 5));
  PieceSeams seams = piece.seams();
  const SeamEdges cut = seams.cut_to(4 * 17 + 12, false, 0, piece.one_chart);
  seams.add(cut);
  CHECK(cut.size() >= 8);
  CHECK(seams.length(cut) > 8);
  CHECK(piece.symmetric(seams));
  CHECK(piece.charts(seams).size() == 1);
  CHECK(seams.cut_to(4 * 17 + 4, false, 0, piece.one_chart).empty());  // reached by the image
}

TEST_CASE("a hole is joined to the border, not to itself") {
  Mesh mesh = quad_grid(9, 9);
  mesh.points[0].z() = 1e-2;  // no symmetry
  Mesh holed;
  holed.points = mesh.points;
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const int x = f % 9, y = f / 9;
    if (x >= 3 && x < 6 && y >= 3 && y < 6) continue;
    holed.add({mesh.corners.begin() + mesh.offsets[f], mesh.corners.begin() + mesh.offsets[f + 1]});
  }
  const OnePiece piece(holed);
  PieceSeams seams = piece.seams();
  seams.add(seams.cut_to(3 * 10 + 4, true, 0, piece.one_chart));
  CHECK(seams.edges().size() == 3);
  CHECK(piece.charts(seams)[0].boundary_loops.size() == 1);
}

TEST_CASE("parts are cut apart symmetrically") {
  const OnePiece piece(spiky_grid(2, 5));
  PieceSeams seams = piece.seams();
  const std::size_t n = piece.one_chart.size();
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  std::vector<Eigen::Vector3d> centers;
  for (const int f : all) centers.push_back(piece.mesh.points[piece.mesh.corners[piece.mesh.offsets[f]]]);
  const SeparableFaces faces(seams.graph(), all, std::vector<double>(n, 1), centers);
  seams.add(seams.cut_apart(faces, {3 * 16 + 3}, {3 * 16 + 8}, piece.one_chart));
  CHECK(piece.charts(seams).size() >= 2);
  CHECK(piece.symmetric(seams));
}

TEST_CASE("new seams fall into chains between crossings, which can be taken away again") {
  const OnePiece flat(bent_grid(8, 4));
  PieceSeams seams = flat.seams();
  const auto edge = [&](int a, int b) { return seams.graph().find_edge(a, b); };
  // From the left border along the row of vertices 18 to 22, with a branch down from 20.
  const SeamEdges row{edge(18, 19), edge(19, 20), edge(20, 21), edge(21, 22)};
  const SeamEdges branch{edge(20, 29)};
  seams.add(row);
  seams.add(branch);
  const std::vector<SeamChain> chains = seams.chains();
  REQUIRE(chains.size() == 3);
  std::size_t n_edges = 0;
  int tips = 0;
  for (const SeamChain& chain : chains) {
    n_edges += chain.edges.size();
    tips += (chain.is_tip[0] ? 1 : 0) + (chain.is_tip[1] ? 1 : 0);
    CHECK_FALSE(chain.is_own_image);
    // From the first end to the second.
    int v = chain.ends[0];
    for (const int e : chain.edges) {
      const auto ends = seams.graph().edges()[static_cast<std::size_t>(e)].vertices;
      REQUIRE((ends[0] == v || ends[1] == v));
      v = seams.graph().edges()[static_cast<std::size_t>(e)].other_end(v);
    }
    CHECK(v == chain.ends[1]);
  }
  CHECK(n_edges == 5);
  CHECK(tips == 2);
  CHECK(seams.changed({}, branch).size() == 4);
  CHECK(seams.changed({edge(22, 23)}, branch).size() == 5);
  seams.remove(branch);
  CHECK(seams.edges() == row);
  CHECK_FALSE(seams.graph().edges()[branch.front()].cut);
  REQUIRE(seams.chains().size() == 1);
  CHECK(seams.chains().front().edges.size() == 4);
}

TEST_CASE("a jagged chain is straightened, a straight one stays") {
  const OnePiece flat(bent_grid(8, 4));
  PieceSeams seams = flat.seams();
  const auto edge = [&](int a, int b) { return seams.graph().find_edge(a, b); };
  // From the left border to vertex 23 and back and forth between two rows.
  const SeamEdges jagged{edge(18, 19), edge(19, 28), edge(28, 29), edge(29, 20), edge(20, 21), edge(21, 22)};
  seams.add(jagged);
  REQUIRE(seams.chains().size() == 1);
  const SeamChain chain = seams.chains().front();
  seams.remove(jagged);
  const SeamEdges straight = seams.straightened(chain, 0.5);
  CHECK(seams.cost(straight) < seams.cost(jagged));
  CHECK(straight.size() == 4);
  seams.add(straight);
  const SeamChain again = seams.chains().front();
  seams.remove(straight);
  CHECK(seams.straightened(again, 0.5).empty());
}

TEST_CASE("a chain that is nearly a loop stays around what it encloses, and a narrow corridor keeps its shape") {
  const OnePiece flat(bent_grid(10, 10));
  PieceSeams seams = flat.seams();
  const auto edge = [&](int a, int b) { return seams.graph().find_edge(a, b); };
  const auto vertex = [](int x, int y) { return 11 * y + x; };
  // From (5, 2) around a square to (4, 2), one edge from its start.
  SeamEdges loop;
  for (int x = 5; x < 8; ++x) loop.push_back(edge(vertex(x, 2), vertex(x + 1, 2)));
  for (int y = 2; y < 8; ++y) loop.push_back(edge(vertex(8, y), vertex(8, y + 1)));
  for (int x = 8; x > 2; --x) loop.push_back(edge(vertex(x, 8), vertex(x - 1, 8)));
  for (int y = 8; y > 2; --y) loop.push_back(edge(vertex(2, y), vertex(2, y - 1)));
  for (int x = 2; x < 4; ++x) loop.push_back(edge(vertex(x, 2), vertex(x + 1, 2)));
  seams.add(loop);
  REQUIRE(seams.chains().size() == 1);
  const SeamChain chain = seams.chains().front();
  seams.remove(loop);
  CHECK(seams.straightened(chain, 0.5).size() != 1);
  CHECK(seams.straightened(chain, 0).empty());
}

TEST_CASE("a chain's ends slide along the cuts that it meets") {
  const OnePiece flat(bent_grid(8, 4));
  PieceSeams seams = flat.seams();
  // From the left border in one row to the right border in the next.
  const SeamEdges jog = edges_along(seams, {18, 19, 20, 11, 12, 13, 14, 15, 16, 17});
  seams.add(jog);
  REQUIRE(seams.chains().size() == 1);
  const SeamChain chain = seams.chains().front();
  seams.remove(jog);
  const SeamEdges straight = seams.straightened(chain, 0.25);
  CHECK(straight.size() == 8);
  CHECK(seams.graph().turning(straight) == 0);
  CHECK(seams.straightened(chain, 1e-3).empty());
}

TEST_CASE("a chain across the mirror plane is straightened with its image") {
  Mesh grid = quad_grid(8, 4);
  for (Eigen::Vector3d& p : grid.points)
    p.z() = 0.01 * (p.x() - grid.points[4].x()) * (p.x() - grid.points[4].x()) * p.y();
  const OnePiece sheet(std::move(grid));
  PieceSeams seams = sheet.seams();
  REQUIRE(seams.is_symmetric());
  const SeamEdges jog = edges_along(seams, {18, 19, 20, 29, 30, 31, 32, 33, 24, 25, 26});
  seams.add(jog);
  REQUIRE(seams.chains().size() == 1);
  const SeamChain chain = seams.chains().front();
  REQUIRE(chain.is_own_image);
  seams.remove(jog);
  const SeamEdges straight = seams.straightened(chain, 0.25);
  CHECK(straight.size() == 8);
  CHECK(seams.graph().turning(straight) == 0);
  seams.add(straight);
  CHECK(sheet.symmetric(seams));
}

TEST_CASE("a closed chain moves onto the edge loop beside it") {
  const OnePiece piece(torus(12, 8));
  PieceSeams seams = piece.seams();
  seams.forget_symmetry();
  // Around the tube, with a step aside and back.
  const SeamEdges ring = edges_along(seams, {0, 1, 2, 10, 11, 12, 13, 5, 6, 7, 0});
  seams.add(ring);
  const std::vector<SeamChain> chains = seams.chains();
  REQUIRE(chains.size() == 1);
  seams.remove(ring);
  const SeamEdges moved = seams.straightened(chains.front(), 0.25);
  CHECK(moved.size() == 8);
  CHECK(seams.graph().turning(moved) == 0);
  CHECK(seams.straightened(chains.front(), 1e-3).empty());  // no loop is so near
  seams.add(moved);
  const SeamChain straight = seams.chains().front();
  seams.remove(moved);
  CHECK(seams.straightened(straight, 1e-3).empty());
}

TEST_CASE("a cut that meets a closed chain goes on to the edge loop onto which the chain moves") {
  const OnePiece piece(torus(12, 8));
  PieceSeams seams = piece.seams();
  seams.forget_symmetry();
  const SeamEdges ring = edges_along(seams, {0, 1, 2, 10, 11, 12, 13, 5, 6, 7, 0});
  seams.add(ring);
  seams.add(edges_along(seams, {11, 19, 27}));
  const std::vector<SeamChain> chains = seams.chains();
  const auto closed = std::find_if(chains.begin(), chains.end(), [](const auto& c) { return c.edges.size() == 10; });
  REQUIRE(closed != chains.end());
  seams.remove(ring);
  const SeamEdges moved = seams.straightened(*closed, 0.25);
  CHECK(moved.size() == 9);
  CHECK(std::count(moved.begin(), moved.end(), seams.graph().find_edge(3, 11)) == 1);
}

TEST_CASE("an edge loop that is cut but for a narrow hinge is an open ring, and lacks the rest") {
  const MirroredPieces parts = MirroredPieces::of(torus(12, 8).view());
  PieceSeams seams(parts.pieces[0], 0, parts.mirrors[0], parts.symmetry);
  seams.forget_symmetry();
  const EdgeLoops found = EdgeLoops::of(seams.graph());
  std::vector<SeamEdges> rings;
  std::copy_if(found.loops.begin(), found.loops.end(), std::back_inserter(rings),
               [](const SeamEdges& loop) { return loop.size() == 8; });
  const SeamEdges& ring = rings[1];
  const SeamEdges half(ring.begin(), ring.begin() + 4);
  const SeamEdges more(ring.begin() + 4, ring.begin() + 6);
  SeamEdges rest(ring.begin() + 6, ring.end());
  std::sort(rest.begin(), rest.end());
  seams.add(half);
  seams.add(more);
  // The torus would stay in one part.
  CHECK(seams.open_rings({}, {}) == 0);
  CHECK(seams.missing_in_rings().empty());
  seams.add(rings[0]);
  const double open = seams.open_rings({}, {});
  CHECK(open > 0.2);
  CHECK(open < 0.8);
  SeamEdges most = more;
  most.push_back(half.back());
  CHECK(seams.open_rings({}, most) == 0);
  CHECK(seams.open_rings(rest, {}) == 0);
  CHECK(seams.missing_in_rings() == std::vector<SeamEdges>{rest});
  PieceSeams shortest = seams;
  shortest.scale_turns(0);
  CHECK(shortest.open_rings({}, {}) == 0);
  CHECK(shortest.missing_in_rings().empty());
  seams.add(rest);
  CHECK(seams.missing_in_rings().empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
