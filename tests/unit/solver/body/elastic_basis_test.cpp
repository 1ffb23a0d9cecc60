// One basis for bodies that are the same in different places.
#include <gtest/gtest.h>

#include "unit/solver/body_models.h"

namespace topple::test {
namespace {

class SharedBasis : public ::testing::Test {
 protected:
  SharedBasis() : model_(steel_model()) { add(tall_cabinet()); }
  /// The basis of another cabinet.
  const ElasticBasis* add(CabinetSpec spec, const Vec3& at = Vec3::Zero()) {
    spec.name += std::to_string(model_.bodies.size());
    spec.at += at;
    add_cabinet(model_, spec);
    Body& body = model_.bodies.back();
    body.elastic = elastic_basis(model_, static_cast<int>(model_.bodies.size()) - 1);
    return body.elastic.get();
  }
  const ElasticBasis* first() const { return model_.bodies[0].elastic.get(); }

  Model model_;
};

TEST_F(SharedBasis, of_a_body_elsewhere_is_the_first_s) {
  EXPECT_EQ(add(tall_cabinet(), Vec3(3.7, -1.3, 0)), first());
  Model alone = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.at += Vec3(3.7, -1.3, 0);
  add_cabinet(alone, spec);
  const auto own = elastic_basis(alone, 0);
  for (int k = 0; k < own->modes; ++k)
    EXPECT_NEAR(own->frequency[k], first()->frequency[k], 1e-9 * own->frequency[k]);  // but for rounding
  const double deflection = own->residual_shape.cwiseAbs().maxCoeff();
  EXPECT_LT((own->residual_shape - first()->residual_shape).cwiseAbs().maxCoeff(), 1e-6 * deflection);
}

TEST_F(SharedBasis, of_a_body_that_differs_is_its_own) {
  CabinetSpec heavy = tall_cabinet(), turned = tall_cabinet(), taller = tall_cabinet(), low = tall_cabinet();
  heavy.mass *= 1.001;
  turned.yaw = 0.01;
  taller.size.z() += 1e-3;
  low.cg_height -= 1e-3;
  for (const CabinetSpec& spec : {heavy, turned, taller, low}) {
    const ElasticBasis* const own = add(spec, Vec3(3, 0, 0));
    EXPECT_NE(own, nullptr);
    EXPECT_NE(own, first());
  }
  model_.materials[0].young *= 2;
  EXPECT_NE(add(tall_cabinet(), Vec3(3, 0, 0)), first());
}

}  // namespace
}  // namespace topple::test
