#!/usr/bin/env python3
"""Checks that sources include what they use of the precompiled headers, without which a build would fail.

A source that uses a name of such a header (scripts/cmake/FurrowCompiler.cmake lists them) must include the header
itself, through headers of this project, or through one that is documented to bring it (BRINGS).

usage: scripts/check_headers.py [--root FOLDER]
Prints every name without its header as FILE:LINE and exits with 1 if there is one.
"""
import argparse
import functools
import pathlib
import re
import sys

ALGORITHMS = ("adjacent_find all_of any_of binary_search clamp copy copy_if copy_n count count_if equal equal_range "
              "fill fill_n find find_first_of find_if find_if_not for_each generate includes inplace_merge "
              "is_permutation is_sorted lexicographical_compare lower_bound max max_element merge min min_element "
              "minmax minmax_element mismatch next_permutation none_of nth_element partial_sort partition "
              "partition_point remove_copy remove_if replace replace_if reverse rotate sample search set_difference "
              "set_intersection set_union shuffle sort stable_partition stable_sort swap_ranges transform unique "
              "upper_bound").split()
# What a source uses that includes the header.
NAMES = {
    "algorithm": rf"std::(ranges::)?({'|'.join(ALGORITHMS)})\b(?=[(<])",
    "filesystem": r"std::filesystem\b",
    "functional": r"std::(function|reference_wrapper|hash|less|greater|plus|multiplies|bit_or|ref|cref|"
                  r"invoke|bind_front|mem_fn)\b(?=[(<])",
    "memory": r"std::(unique_ptr|shared_ptr|weak_ptr|make_unique|make_shared|enable_shared_from_this|allocator|"
              r"addressof)\b",
    "span": r"std::(span|as_bytes|as_writable_bytes)\b",
    "string": r"std::(string|to_string|stoi|stol|stoul|stoull|stod|getline|char_traits)\b",
    "vector": r"std::vector\b",
    "fmt/format.h": r"\bfmt::\w",
    "nlohmann/json.hpp": r"\bnlohmann::\w",
    "Eigen/Core": r"\bEigen::\w",
    "Eigen/Geometry": r"\bEigen::(Quaternion\w*|AngleAxis\w*|AlignedBox\w*|Isometry\w*|Transform|Translation\w*|"
                      r"Hyperplane|ParametrizedLine)\b",
    "gtest/gtest.h": r"\b(TEST|TEST_F|TEST_P|EXPECT_\w+|ASSERT_\w+)\b",
}
# What a header brings by its own documentation, or where a declaration is enough.
BRINGS = {
    "Eigen/Dense": {"Eigen/Core", "Eigen/Geometry"},
    "Eigen/Geometry": {"Eigen/Core"},
    "Eigen/Sparse": {"Eigen/Core"},
    "Eigen/SparseCore": {"Eigen/Core"},
    "Eigen/Eigenvalues": {"Eigen/Core"},
    "Eigen/Cholesky": {"Eigen/Core"},
    "Eigen/LU": {"Eigen/Core"},
    "Eigen/QR": {"Eigen/Core"},
    "Eigen/SVD": {"Eigen/Core"},
    "nlohmann/json_fwd.hpp": {"nlohmann/json.hpp"},
    "gmock/gmock.h": {"gtest/gtest.h"},
    "sstream": {"string"},
    "fstream": {"string"},
    "stdexcept": {"string"},
}
ROOMS = ("protocol", "tire", "terrain", "vehicle", "rigs", "nodes", "tests")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
COMMENT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)


def precompiled(root):
    """What scripts/cmake/FurrowCompiler.cmake precompiles."""
    text = (root / "scripts/cmake/FurrowCompiler.cmake").read_text()
    lists = re.findall(r"set\(_headers([^)]*)\)", text) + re.findall(r"target_precompile_headers\(([^)]*)\)", text)
    return set(re.findall(r"<([\w/.]+)>", " ".join(lists)))


def problems(root):
    headers = precompiled(root)
    if unknown := headers - NAMES.keys():
        yield (f"scripts/cmake/FurrowCompiler.cmake: precompiles <{min(unknown)}>, of which scripts/check_headers.py "
               f"knows no names")
    patterns = {header: re.compile(pattern) for header, pattern in NAMES.items() if header in headers}

    @functools.cache
    def text(file):
        return (root / file).read_text()

    @functools.cache
    def brought(file):
        """Headers of other projects that a file includes, directly and through headers of this one."""
        found, seen, work = set(), {file}, [file]
        while work:
            for name in INCLUDE.findall(text(work.pop())):
                if (root / name).is_file():
                    if name not in seen:
                        seen.add(name)
                        work.append(name)
                else:
                    found |= {name} | BRINGS.get(name, set())
        return found

    for room in ROOMS:
        for path in sorted((root / room).rglob("*.[ch]pp")):
            file = str(path.relative_to(root))
            bare = COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text(file))
            for header, pattern in patterns.items():
                if header not in brought(file) and (use := pattern.search(bare)):
                    yield f"{file}:{bare.count(chr(10), 0, use.start()) + 1}: uses {use[0]} without #include <{header}>"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    found = list(problems(parser.parse_args().root))
    for problem in found:
        print(problem)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
