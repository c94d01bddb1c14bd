#include "graph/numbering.h"

namespace spectral_conformal {

std::vector<int> indices_in(const std::vector<int>& order, std::size_t n) {
  std::vector<int> result(n, -1);
  for (std::size_t i = 0; i < order.size(); ++i) result[order[i]] = static_cast<int>(i);
  return result;
}

std::vector<int> number_marked(std::vector<int>& marks) {
  std::vector<int> marked;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i] < 0) continue;
    marks[i] = static_cast<int>(marked.size());
    marked.push_back(static_cast<int>(i));
  }
  return marked;
}

}  // namespace spectral_conformal
