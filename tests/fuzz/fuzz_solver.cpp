// libFuzzer on the unwrap of a mesh, with options of every kind.
#include <cmath>

#include "fuzzed_mesh.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/kept_maps.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal::fuzz {
namespace {

UnwrapOptions options_from(Bytes& bytes, const FuzzedMesh& mesh) {
  UnwrapOptions options;
  const int bits = bytes.byte();
  options.patch.weights = (bits & 1) != 0 ? Weights::inverse_area : Weights::uniform;
  options.patch.boundary = (bits & 2) != 0 ? BoundaryMeasure::vertex : BoundaryMeasure::length;
  options.patch.backend = (bits & 4) != 0 ? FactorizationBackend::eigen : FactorizationBackend::automatic;
  options.patch.fill_holes = (bits & 8) != 0;
  if ((bits & 16) != 0) options.patch.area_blend = bytes.byte() / 255.0;
  options.solve.fold_free = bytes.flag();
  constexpr Polish polishes[] = {Polish::off, Polish::angles, Polish::balanced, Polish::balanced};
  options.solve.polish = polishes[bytes.byte() & 3];
  constexpr Method methods[] = {Method::spectral, Method::spectral, Method::spectral, Method::spectral,
                                Method::spectral, Method::lscm,     Method::fiedler,  Method::area};
  options.solve.method = methods[bits >> 5];
  const bool spectral = options.solve.method == Method::spectral;
  if (spectral && bytes.flag()) {
    options.solve.hole_rigidity = bytes.byte() / 32.0;
    if (bytes.flag()) options.solve.hole_rigidity.reset();  // automatic
  }
  if (spectral && bytes.flag()) options.solve.soft_pins = bytes.byte() / 8.0;
  for (int k = bytes.below(4); spectral && k > 0; --k) {
    const int from = bytes.below(mesh.n_vertices());
    options.extenders.push_back({from, bytes.below(mesh.n_vertices()), (bytes.byte() - 128) / 16.0});
  }
  if (options.solve.method == Method::lscm || options.solve.soft_pins > 0) {
    for (int k = bytes.below(5); k > 0; --k) {
      const int vertex = bytes.below(mesh.n_vertices());
      const double u = bytes.number();
      const double v = bytes.number();
      if (std::isfinite(u) && std::isfinite(v)) options.vertex_pins[vertex] = {u, v};
    }
  }
  return options;
}

void check(const Unwrap& result) {
  require(result.uv.allFinite());
  for (const UnwrappedChart& chart : result.charts) {
    if (chart.solved) {
      require(std::isfinite(chart.eigenvalue) && std::isfinite(chart.residual));
      require(!std::isnan(chart.mean_qc) && !std::isnan(chart.max_qc));
    } else {
      require(!chart.steps.empty());
    }
  }
}

}  // namespace
}  // namespace spectral_conformal::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spectral_conformal;
  using namespace spectral_conformal::fuzz;
  Bytes bytes(data, size);
  const FuzzedMesh mesh(bytes);
  const UnwrapOptions options = options_from(bytes, mesh);
  try {
    Unwrapper unwrapper = Unwrapper::of(mesh.view(), options);
    const Unwrap first =
        unwrapper.solve(options.extenders, options.solve.hole_rigidity, options.solve.tolerance, nullptr, {});
    check(first);
    int reports = bytes.byte();
    const Progress listen = [&reports](double, const char*) { return --reports > 0; };
    try {
      const double rigidity = 2 * options.solve.hole_rigidity.value_or(1);
      check(unwrapper.solve(options.extenders, rigidity, options.solve.tolerance, nullptr, listen));
    } catch (const Cancelled&) {
      require(reports <= 0);
    }
    if (bytes.flag()) {
      KeptMaps kept(1'000'000);
      const Unwrap plain = unwrap(mesh.view(), options, {}, &kept);
      const Unwrap again = unwrap(mesh.view(), options, {}, &kept);
      require(again.uv == plain.uv && again.charts.size() == plain.charts.size());
      check(again);
    }
  } catch (const InvalidMesh&) {
    return 0;  // said so
  }
  return 0;
}
