#include "spectral_conformal/seam_suggestion.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <new>
#include <numeric>
#include <optional>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "graph/adjacency.h"
#include "seams/canonical_mesh.h"
#include "seams/congruent_pieces.h"
#include "seams/piece_search.h"
#include "seams/pieces.h"

namespace spectral_conformal {
namespace {

/// The whole mesh in canonical order, and the searches of its pieces.
class SeamFinder {
 public:
  /// mesh_vertices: per canonical vertex, its index in the given mesh.
  SeamFinder(const std::vector<int>& mesh_vertices, const MirroredPieces& parts, const SeamSuggestionOptions& options,
             const Progress& progress)
      : options_(options),
        progress_(progress),
        mesh_vertices_(mesh_vertices),
        parts_(parts),
        searched_(options, parts_, mesh_vertices_),
        usual_options_(LimitStages::no_looser_than_usual(options)) {
    if (LimitStages(options, false).begins_looser()) {
      searched_as_usual_.emplace(usual_options_, parts_, mesh_vertices_);
    }
    const std::vector<PieceCopy> copies =
        copies_of_pieces(parts_, searched_.preferences, std::isinf(options.max_length) && !(options.qc_gain > 0));
    copies_.resize(copies.size());
    for (std::size_t i = 0; i < copies.size(); ++i) {
      copies_[copies[i].source].push_back({static_cast<int>(i), copies[i].vertex});
      const bool is_searched = has_extent(parts_.pieces[i]) && copies[i].source == static_cast<int>(i);
      poll();
      searches_.push_back(is_searched ? new_search(i) : nullptr);
    }
  }

  SeamSuggestion run() {
    if (std::isfinite(options_.max_length)) {
      search_within_length();
    } else {
      search_each();
    }
    report(progress_, 1.0, "done");
    const auto is_searched = [](const auto& search) { return search != nullptr; };
    if (!given_up_.empty() && std::none_of(searches_.begin(), searches_.end(), is_searched)) throw std::bad_alloc();
    return result();
  }

 private:
  std::unique_ptr<PieceSearch> new_search(std::size_t i) const {
    return std::make_unique<PieceSearch>(searched_, static_cast<int>(i));
  }
  /// Searches the pieces independently, the largest first: smaller ones keep the other threads busy.
  void search_each() {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < searches_.size(); ++i) {
      if (searches_[i]) order.push_back(i);
    }
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) {
      return parts_.pieces[a].vertices.size() > parts_.pieces[b].vertices.size();
    });
    std::size_t n_large = 0;
    for (; n_large < order.size() && searches_[order[n_large]]->is_large(); ++n_large) {
      search(order[n_large], progress_);
    }
    std::vector<char> is_left(order.size(), 0);
    run_in_parallel(
        static_cast<int>(order.size() - n_large),
        [&](int k, const Progress& own_progress) {
          const std::size_t rank = n_large + static_cast<std::size_t>(k);
          is_left[rank] = !search(order[rank], own_progress);
        },
        progress_, "seams", tries_at_once);
    const bool were_others = order.size() - n_large > 1;
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
      const std::size_t i = order[rank];
      if (is_left[rank] && were_others) {
        // Try once more, alone.
        if (searches_[i]) {
          search_as_usual(i, progress_);
        } else {
          searches_[i] = new_search(i);
          search(i, progress_);
        }
      }
      if (!searches_[i]) given_up_.push_back(i);
    }
  }
  /// Does some work on a search. If memory runs out, drops it and returns false.
  template <class Work>
  static bool has_memory_for(std::unique_ptr<PieceSearch>& search, const Work& work) {
    try {
      work();
      return true;
    } catch (const std::bad_alloc&) {
      search.reset();
      return false;
    }
  }
  /// Where limits are looser than usual, searches twice. Returns false if memory runs out; a finished search stays.
  bool search(std::size_t i, const Progress& own_progress) {
    return has_memory_for(searches_[i], [&] { run(*searches_[i], own_progress); }) && search_as_usual(i, own_progress);
  }
  bool search_as_usual(std::size_t i, const Progress& own_progress) {
    if (!searches_[i]->begins_looser()) return true;
    std::unique_ptr<PieceSearch> usual;
    const auto work = [&] {
      usual = std::make_unique<PieceSearch>(*searched_as_usual_, static_cast<int>(i));
      run(*usual, own_progress);
    };
    if (!has_memory_for(usual, work)) return false;
    // In single precision, so that rounding does not decide.
    const auto length = [](const PieceSearch& of) { return static_cast<float>(of.length()); };
    if (length(*usual) < length(*searches_[i])) searches_[i] = std::move(usual);
    return true;
  }
  void run(PieceSearch& search, const Progress& own_progress) {
    search.begin(quiet(own_progress));
    while (!search.finished()) {
      ++steps_;
      search.step(options_.max_length, quiet(own_progress));
    }
  }
  /// Makes the cuts that topology needs, then always the most urgent cut, while there is length left.
  void search_within_length() {
    for (std::size_t i = 0; i < searches_.size(); ++i) {
      if (!searches_[i]) continue;
      if (!has_memory_for(searches_[i], [&] { searches_[i]->begin(quiet(progress_)); })) given_up_.push_back(i);
    }
    std::vector<double> lengths(searches_.size(), 0);
    double total = 0;
    std::priority_queue<std::pair<double, int>> next;  // of equal urgency, the first piece first
    const auto look_at = [&](std::size_t i) {
      total -= std::exchange(lengths[i], copies(i) * searches_[i]->length());
      total += lengths[i];
      if (!searches_[i]->finished()) next.emplace(searches_[i]->urgency(), -static_cast<int>(i));
    };
    for (std::size_t i = 0; i < searches_.size(); ++i) {
      if (searches_[i]) look_at(i);
    }
    while (!next.empty()) {
      const auto i = static_cast<std::size_t>(-next.top().second);
      next.pop();
      ++steps_;
      const double length = (options_.max_length - total) / copies(i);
      if (has_memory_for(searches_[i], [&] { searches_[i]->step(length, quiet(progress_)); })) {
        look_at(i);
      } else {
        given_up_.push_back(i);
        total -= lengths[i];
      }
    }
  }
  /// Solves report that they are running, not how far they are: the fraction rises with the steps of the search.
  Progress quiet(const Progress& progress) const {
    return [this, &progress](double, const char*) {
      return !progress || progress(1 - 0.98 / (1 + 0.1 * steps_), "seams");
    };
  }
  /// How many pieces get the seams of this one, which is searched.
  int copies(std::size_t piece) const { return static_cast<int>(copies_[piece].size()); }
  /// The cuts of all pieces, most urgent first.
  SeamSuggestion result() const {
    SeamSuggestion result;
    std::set<std::array<int, 2>> proposed;
    std::vector<std::tuple<double, std::size_t, std::size_t>> order;  // minus the urgency, piece, cut
    for (std::size_t i = 0; i < searches_.size(); ++i) {
      for (std::size_t k = 0; searches_[i] && k < searches_[i]->cuts().size(); ++k) {
        order.emplace_back(-searches_[i]->cuts()[k].urgency, i, k);
      }
    }
    std::sort(order.begin(), order.end());
    for (const auto& [urgency, i, k] : order) add(i, searches_[i]->cuts()[k], proposed, result);
    for (const std::size_t i : given_up_) {
      result.given_up_vertices = std::max(result.given_up_vertices, static_cast<int>(parts_.pieces[i].vertices.size()));
      result.n_given_up += copies(i);
    }
    return result;
  }
  void add(std::size_t i, const PieceSearch::Cut& cut, std::set<std::array<int, 2>>& proposed,
           SeamSuggestion& result) const {
    for (const Copy& copy : copies_[i]) {
      const auto in_mesh = [&](int v) {
        return mesh_vertices_[parts_.pieces[copy.piece].vertices[copy.vertex.empty() ? v : copy.vertex[v]]];
      };
      for (const auto& [a, b] : cut.edges) {
        const auto edge = edge_between(in_mesh(a), in_mesh(b));
        poll();
        // Pieces that meet at an edge of three or more faces may both propose it.
        if (proposed.insert(edge).second) result.edges.push_back(edge);
      }
    }
    const int end = static_cast<int>(result.edges.size());
    if (end > result.cut_offsets.back()) result.cut_offsets.push_back(end);
  }

  /// A piece that gets the seams of another one, or its own.
  struct Copy {
    int piece;
    std::vector<int> vertex;  ///< PieceCopy::vertex
  };

  const SeamSuggestionOptions& options_;
  const Progress& progress_;
  const std::vector<int>& mesh_vertices_;
  const MirroredPieces& parts_;
  std::vector<std::vector<Copy>> copies_;  ///< per piece that is searched
  SearchedMesh searched_;
  SeamSuggestionOptions usual_options_;
  std::optional<SearchedMesh> searched_as_usual_;  ///< for looser limits
  std::vector<std::unique_ptr<PieceSearch>> searches_;
  std::vector<std::size_t> given_up_;  ///< pieces without enough memory
  std::atomic<int> steps_{0};          ///< counted by several threads
};

double length(const PolygonMesh& mesh, const std::vector<std::array<int, 2>>& edges) {
  double sum = 0;
  for (const auto& [a, b] : edges) {
    sum += (Eigen::Map<const Eigen::Vector3d>(mesh.position(a)) - Eigen::Map<const Eigen::Vector3d>(mesh.position(b)))
               .norm();
  }
  return sum;
}

}  // namespace

SeamSuggestion suggest_seams(const PolygonMesh& mesh, const SeamSuggestionOptions& options, const Progress& given) {
  const CancellationScope scope(given, "charts");
  const Progress& progress = scope.progress();
  validate(mesh);
  report(progress, 0.0, "charts");
  CanonicalMesh canonical;
  MirroredPieces parts;
  call_while_polling(steps_per_face * mesh.n_corners(), [&] {
    canonical = CanonicalMesh::of(mesh);
    parts = MirroredPieces::of(canonical.view());
  });
  if (!std::isfinite(options.max_length)) return SeamFinder(canonical.vertices, parts, options, progress).run();
  // A limit that is not reached changes nothing. In single precision, so that rounding does not decide.
  SeamSuggestionOptions unlimited = options;
  unlimited.max_length = infinity;
  SeamSuggestion whole = SeamFinder(canonical.vertices, parts, unlimited, part(progress, 0, 0.5)).run();
  if (static_cast<float>(length(mesh, whole.edges)) <= static_cast<float>(options.max_length)) {
    report(progress, 1.0, "done");
    return whole;
  }
  return SeamFinder(canonical.vertices, parts, options, part(progress, 0.5, 1)).run();
}

}  // namespace spectral_conformal
