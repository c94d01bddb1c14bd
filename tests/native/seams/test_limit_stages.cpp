#include <doctest/doctest.h>

#include "seams/limit_stages.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("limit_stages");

TEST_CASE("the default limits are the only stage for themselves") {
  const SeamSuggestionOptions usual;
  LimitStages stages(usual, false);
  CHECK(stages.limits().energy_limit == usual.energy_limit);
  CHECK(stages.limits().qc_limit == usual.qc_limit);
  CHECK(stages.limits().scale_limit == usual.scale_limit);
  CHECK_FALSE(stages.advance());
}

TEST_CASE("for stricter limits each stage allows half, but as much as before where the default limit is left") {
  const SeamSuggestionOptions usual;
  SeamSuggestionOptions asked;
  asked.qc_limit = 1.03;
  LimitStages stages(asked, false);
  CHECK(stages.limits().qc_limit == usual.qc_limit);
  for (const double qc_limit : {1.05, 1.025}) {
    CHECK(stages.advance());
    CHECK(stages.limits().qc_limit == doctest::Approx(qc_limit));
    CHECK(stages.limits().scale_limit == usual.scale_limit);
  }
  CHECK_FALSE(stages.advance());
}

TEST_CASE("for looser limits the stages begin far beyond them, and are the same for all") {
  SeamSuggestionOptions asked;
  asked.qc_limit = 1.3;
  SeamSuggestionOptions other = asked;
  other.scale_limit = 3;
  LimitStages stages(asked, false), same(other, false);
  CHECK(stages.limits().qc_limit == doctest::Approx(2.6));
  int n_stages = 1;
  do {
    CHECK(stages.limits().qc_limit == same.limits().qc_limit);
    CHECK(stages.limits().scale_limit == same.limits().scale_limit);
    CHECK(stages.limits().energy_limit == same.limits().energy_limit);
    same.advance();
    ++n_stages;
  } while (stages.limits().qc_limit > 1.3 && stages.advance());
  CHECK(n_stages == 5);
  // The other limits are those by default.
  CHECK(stages.advance());
  CHECK_FALSE(stages.advance());
}

TEST_CASE("where the first stage is looser than usual, the looser limits are replaced by the usual ones") {
  const SeamSuggestionOptions usual;
  SeamSuggestionOptions asked;
  CHECK_FALSE(LimitStages(asked, false).begins_looser());
  asked.energy_limit = 4.01;
  asked.qc_limit = 1.3;
  CHECK(LimitStages(asked, false).begins_looser());
  CHECK_FALSE(LimitStages(asked, true).begins_looser());
  const SeamSuggestionOptions replaced = LimitStages::no_looser_than_usual(asked);
  CHECK((replaced.energy_limit == 4.01 && replaced.qc_limit == usual.qc_limit));
  CHECK(replaced.scale_limit == usual.scale_limit);
}

TEST_CASE("coarse copies may have less energy, unless the shortest seams are wanted") {
  SeamSuggestionOptions asked;
  asked.energy_limit = 4.2;
  asked.shortest = true;
  CHECK(LimitStages(asked, true).limits_of_copies().energy_limit == 4.2);
  asked.shortest = false;
  const LimitStages stages(asked, true);
  CHECK(stages.limits_of_copies().energy_limit - 4 < stages.limits().energy_limit - 4);
  CHECK(stages.limits_of_copies().energy_limit > 4);
  CHECK(stages.limits_of_copies().qc_limit == stages.limits().qc_limit);
}

TEST_CASE("limits that no map can meet have a last stage") {
  SeamSuggestionOptions asked;
  asked.energy_limit = 4;
  asked.qc_limit = asked.scale_limit = 1;
  LimitStages stages(asked, false);
  int n_stages = 1;
  while (stages.advance()) ++n_stages;
  CHECK(n_stages == 7);
}

TEST_CASE("a piece with coarse copies has stages only for stricter limits") {
  for (const double qc_limit : {1.02, 1.3}) {
    SeamSuggestionOptions asked;
    asked.qc_limit = qc_limit;
    LimitStages stages(asked, true);
    CHECK(stages.advance() == (qc_limit < SeamSuggestionOptions{}.qc_limit));
  }
}

TEST_CASE("the shortest seams, a limited length and a price of QC know no stages") {
  for (const int which : {0, 1, 2}) {
    SeamSuggestionOptions asked;
    asked.qc_limit = 1.01;
    if (which == 0) asked.shortest = true;
    if (which == 1) asked.max_length = 3;
    if (which == 2) asked.qc_gain = 0.001;
    LimitStages stages(asked, false);
    CHECK(stages.limits().qc_limit == asked.qc_limit);
    CHECK_FALSE(stages.advance());
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
