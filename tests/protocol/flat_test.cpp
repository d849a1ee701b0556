#include "protocol/core/flat.hpp"

#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(Flat, vectors_lie_one_after_another_and_come_back) {
  const std::vector<Vec3> points{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  Archive archive;
  put_flat(archive, "points", points);
  EXPECT_EQ(archive.get<double>("points"), (std::vector<double>{1.0, 2.0, 3.0, 4.0, 5.0, 6.0}));
  EXPECT_EQ(get_flat<Vec3>(archive, "points", 2), points);
  EXPECT_EQ(get_flat<Vec3>(archive, "points"), points);
}

TEST(Flat, matrices_lie_column_by_column_and_come_back) {
  Mat3 m;
  m << 1.0, 4.0, 7.0, 2.0, 5.0, 8.0, 3.0, 6.0, 9.0;
  Archive archive;
  put_flat(archive, "matrices", std::vector<Mat3>{m});
  EXPECT_EQ(archive.get<double>("matrices"),
            (std::vector<double>{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0}));
  EXPECT_EQ(get_flat<Mat3>(archive, "matrices", 1), std::vector<Mat3>{m});
}

TEST(Flat, another_number_of_values_is_an_error) {
  Archive archive;
  archive.put("points", std::vector<double>(7, 0.0));
  EXPECT_THROW(get_flat<Vec3>(archive, "points", 2), Error);
  EXPECT_THROW(get_flat<Vec3>(archive, "points", 3), Error);
  EXPECT_THROW(get_flat<Vec3>(archive, "points"), Error);
}

TEST(Flat, matrices_of_several_sizes_are_taken_in_the_order_they_were_added) {
  const Mat3 a = Mat3::Identity();
  const Vec3 b(1.0, 2.0, 3.0);
  std::vector<double> flat;
  append_numbers(flat, a, b);
  ASSERT_EQ(flat.size(), 12u);
  Mat3 first;
  Vec3 second;
  EXPECT_EQ(take_numbers(flat.data(), first, second), flat.data() + flat.size());
  EXPECT_EQ(first, a);
  EXPECT_EQ(second, b);
}

}  // namespace
}  // namespace furrow
