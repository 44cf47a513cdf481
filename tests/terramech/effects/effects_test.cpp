#include <cmath>
#include <set>
#include <string>

#include "effects_fixture.hpp"

namespace talus::terramech {
namespace effects_test {

TEST(Effects, NamesAreUniqueAndEveryFormIsDocumented) {
  std::set<std::string> seen;
  for (const EffectForm& form : effectLibrary()) {
    EXPECT_TRUE(seen.insert(form.name).second) << form.name;
    EXPECT_TRUE(form.act || form.read) << form.name;
    EXPECT_STRNE(form.formula, "") << form.name;
    EXPECT_STRNE(form.source, "") << form.name;
    for (const EffectParameter& p : form.parameters) {
      EXPECT_LE(p.low, p.typical) << form.name << ' ' << p.name;
      EXPECT_GE(p.high, p.typical) << form.name << ' ' << p.name;
    }
  }
}

TEST(Effects, EveryFormHasAFiniteEffectAtItsTypicalSize) {
  // Property: every form changes the prediction, by a finite amount below ten loads.
  for (const EffectForm& form : effectLibrary()) {
    RefinedModel model = base();
    model.effects = {typical(form)};
    const WheelState at = state(std::string(form.name) == "skid_sinkage" ? -0.5 : 0.5);
    const double moved = change(predict(model, at), predict(base(), at));
    if (std::string(form.name) == "layered_hardpan") continue;  // acts only if the sinkage reaches the layer
    if (std::string(form.name) == "rear_fill") continue;        // acts only on soil dug by other forms
    EXPECT_GT(moved, 1e-6) << form.name;
    EXPECT_LT(moved, 10.0) << form.name;
  }
}

}  // namespace effects_test
}  // namespace talus::terramech
