// HDF5 files of other programs: no memory beyond the file's size; one message that names the file.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <functional>

#include "protocol/core/error.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "protocol/files/hdf5_handle.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

namespace furrow {
namespace {

using Shape = std::vector<hsize_t>;

class ForeignHdf5 : public ::testing::Test {
 protected:
  std::filesystem::path file() const { return folder_.path() / "foreign.h5"; }

  /// Makes the file with what `fill` puts into it.
  void make(const std::function<void(hid_t)>& fill) const {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Handle handle(H5Fcreate(file().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    ASSERT_TRUE(handle.ok());
    fill(handle);
  }
  /// The error on reading the dataset `x`, without the file's name; empty if there is none.
  std::string complaint(const std::function<void(const Hdf5Reader&)>& read = [](const Hdf5Reader& in) {
    in.get<double>("x");
  }) const {
    const std::string text = refusal(ExitCode::io, [&] { read(Hdf5Reader(file())); });
    EXPECT_EQ(text.find('\n'), std::string::npos);
    return without_file(text, file());
  }

  testing::TemporaryFolder folder_;
};

/// A dataset "x"; nothing is written to it unless there are values.
void put(hid_t out, const Shape& shape, hid_t type = H5T_NATIVE_DOUBLE, hid_t made = H5P_DEFAULT,
         const void* values = nullptr, const char* name = "x") {
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Handle set(H5Dcreate2(out, name, type, space, H5P_DEFAULT, made, H5P_DEFAULT), H5Dclose);
  ASSERT_TRUE(set.ok());
  if (values) H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
}

/// Creation properties of a dataset.
hid_t created(const Shape& chunk = {}) {
  const hid_t made = H5Pcreate(H5P_DATASET_CREATE);
  if (!chunk.empty()) H5Pset_chunk(made, static_cast<int>(chunk.size()), chunk.data());
  return made;
}

TEST_F(ForeignHdf5, numbers_of_every_usual_kind_are_read) {
  const std::array<float, 4> values{1.0F, 2.0F, 3.0F, 4.0F};
  const std::array<unsigned char, 4> big{0, 5, 0, 7};  // 5 and 7, the large end first
  make([&](hid_t out) {
    put(out, {2, 2}, H5T_NATIVE_FLOAT, H5P_DEFAULT, values.data());
    put(out, {2}, H5T_STD_I16BE, H5P_DEFAULT, big.data(), "big");
    put(out, {0, 3}, H5T_NATIVE_DOUBLE, H5P_DEFAULT, nullptr, "none");
    const Handle packed(created({2, 2}), H5Pclose);
    H5Pset_shuffle(packed);
    H5Pset_deflate(packed, 9);
    put(out, {2, 2}, H5T_NATIVE_FLOAT, packed, values.data(), "packed");
  });
  const Hdf5Reader in(file());
  EXPECT_EQ(in.get<double>("x"), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(in.get<double>("packed"), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(in.get<std::int32_t>("big"), (std::vector<std::int32_t>{5, 7}));
  EXPECT_TRUE(in.get<double>("none").empty());
  EXPECT_EQ(in.get<double>("x").size(), 4U) << "a second time";
  EXPECT_EQ(in.datasets().size(), 4U);
}

TEST_F(ForeignHdf5, declared_and_never_written_takes_no_memory) {
  const hsize_t huge = 1000000000000000;
  make([&](hid_t out) { put(out, {huge}, H5T_NATIVE_UINT64, Handle(created({1024}), H5Pclose)); });
  EXPECT_TRUE(holds(complaint(), "'x' is said to have more than 2147483648 numbers"));
  make([&](hid_t out) { put(out, {1000000000}, H5T_NATIVE_DOUBLE, Handle(created({1024}), H5Pclose)); });
  EXPECT_TRUE(holds(complaint(), "is said to have 8000000000 bytes, but 0 are stored"));
  make([&](hid_t out) { put(out, {1000000000}); });
  EXPECT_TRUE(holds(complaint(), "is said to have 8000000000 bytes, but 0 are stored"));
  make([&](hid_t out) {
    put(out, {huge, huge, huge, huge}, H5T_NATIVE_UINT64, Handle(created({1, 1, 1, 1}), H5Pclose));
  });
  EXPECT_TRUE(holds(complaint(), "more than 2147483648 numbers"));
}

/// The file states the size of a contiguous dataset.
TEST_F(ForeignHdf5, sizes_beyond_the_end_of_the_file_are_not_believed) {
  const std::vector<double> values(1000, 1.0);
  make([&](hid_t out) { put(out, {1000}, H5T_NATIVE_DOUBLE, H5P_DEFAULT, values.data()); });
  std::ifstream in(file(), std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  const auto replace_all = [&](std::uint64_t from, std::uint64_t to) {
    const std::string old(reinterpret_cast<const char*>(&from), 8), put(reinterpret_cast<const char*>(&to), 8);
    for (std::size_t at = 0; (at = bytes.find(old, at)) != std::string::npos; at += 8) bytes.replace(at, 8, put);
  };
  replace_all(1000, 100000000);  // numbers
  replace_all(8000, 800000000);  // bytes
  std::ofstream(file(), std::ios::binary) << bytes;
  EXPECT_NE(complaint(), "");
}

TEST_F(ForeignHdf5, what_compresses_beyond_belief_is_refused) {
  const std::vector<double> zeros(4 << 20, 0.0);
  make([&](hid_t out) {
    const Handle packed(created({4 << 20}), H5Pclose);
    H5Pset_deflate(packed, 9);
    put(out, {4 << 20}, H5T_NATIVE_DOUBLE, packed, zeros.data());
  });
  EXPECT_TRUE(holds(complaint(), "bytes, but "));
}

TEST_F(ForeignHdf5, chunks_larger_than_what_is_stored_are_refused) {
  make([&](hid_t out) {
    const Shape most{H5S_UNLIMITED}, now{4};
    const Handle made(created({100000000}), H5Pclose);
    H5Pset_deflate(made, 1);
    const Handle space(H5Screate_simple(1, now.data(), most.data()), H5Sclose);
    const Handle set(H5Dcreate2(out, "x", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, made, H5P_DEFAULT), H5Dclose);
    const std::array<unsigned char, 64> noise{};  // a chunk as it might come, written past the filters
    const hsize_t at = 0;
    H5Dwrite_chunk(set, H5P_DEFAULT, 0, &at, noise.size(), noise.data());
  });
  EXPECT_NE(complaint(), "");
}

TEST_F(ForeignHdf5, datasets_of_anything_but_plain_numbers_are_refused_by_name) {
  const std::string plain = "the dataset 'x' does not hold plain numbers, expected integers or floats of 1 to 8 bytes";
  const Handle text(H5Tcopy(H5T_C_S1), H5Tclose), variable(H5Tcopy(H5T_C_S1), H5Tclose),
      list(H5Tvlen_create(H5T_NATIVE_DOUBLE), H5Tclose), pair(H5Tcreate(H5T_COMPOUND, 16), H5Tclose);
  H5Tset_size(text, 8);
  H5Tset_size(variable, H5T_VARIABLE);
  H5Tinsert(pair, "a", 0, H5T_NATIVE_DOUBLE);
  H5Tinsert(pair, "b", 8, H5T_NATIVE_DOUBLE);
  for (const hid_t type : {static_cast<hid_t>(text), static_cast<hid_t>(variable), static_cast<hid_t>(list),
                           static_cast<hid_t>(pair), H5T_NATIVE_LDOUBLE, H5T_STD_REF_OBJ}) {
    make([&](hid_t out) { put(out, {2}, type); });
    EXPECT_EQ(complaint(), plain);
    EXPECT_EQ(Hdf5Reader(file()).type("x"), Hdf5Type::other);
  }
  make([](hid_t out) { const Handle group(H5Gcreate2(out, "x", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose); });
  EXPECT_EQ(complaint(), "lacks the dataset 'x'");
}

/// A thousand numbers instead of one would overwrite memory after the expected one.
TEST_F(ForeignHdf5, attributes_must_be_one_number_or_one_short_text) {
  const auto attribute = [&](hid_t type, hsize_t count) {
    make([&](hid_t out) {
      const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
      const Handle made(H5Acreate2(out, "a", type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
      ASSERT_TRUE(made.ok());
      const std::vector<char> zeros(count * H5Tget_size(type));
      H5Awrite(made, type, zeros.data());
    });
  };
  const auto number = [&] { return complaint([](const Hdf5Reader& in) { in.integer("a"); }); };
  const auto text = [&] { return complaint([](const Hdf5Reader& in) { in.text("a"); }); };
  const std::string no_number = "holds the attribute 'a' as something else than one number",
                    no_text = "holds the attribute 'a' as something else than a short text";
  attribute(H5T_NATIVE_INT64, 1);
  EXPECT_EQ(number(), "");
  EXPECT_EQ(text(), no_text);
  attribute(H5T_NATIVE_INT64, 1000);
  EXPECT_EQ(number(), no_number);
  const Handle word(H5Tcopy(H5T_C_S1), H5Tclose), page(H5Tcopy(H5T_C_S1), H5Tclose),
      pair(H5Tcreate(H5T_COMPOUND, 16), H5Tclose);
  H5Tset_size(word, 8);
  H5Tset_size(page, 30000);
  H5Tinsert(pair, "a", 0, H5T_NATIVE_DOUBLE);
  attribute(word, 1);
  EXPECT_EQ(number(), no_number);
  EXPECT_EQ(text(), "");
  attribute(word, 100);
  EXPECT_EQ(text(), no_text);
  attribute(page, 1);
  EXPECT_EQ(text(), no_text);
  attribute(pair, 1);
  EXPECT_EQ(number(), no_number);
  EXPECT_EQ(complaint([](const Hdf5Reader& in) { in.integer("b"); }), "lacks the attribute 'b'");
}

TEST_F(ForeignHdf5, names_are_shown_and_not_obeyed) {
  make([](hid_t out) { put(out, {1000000}, H5T_NATIVE_DOUBLE, H5P_DEFAULT, nullptr, "red\x1b[31m\n"); });
  const std::string told = complaint([](const Hdf5Reader& in) { in.get<double>(in.datasets().at(0)); });
  EXPECT_TRUE(holds(told, "'red\\x1b[31m\\n' is said to have"));
}

TEST_F(ForeignHdf5, what_is_no_regular_file_is_refused) {
  std::filesystem::create_directory(file());
  EXPECT_EQ(complaint(), "is not a regular file");
}

}  // namespace
}  // namespace furrow
