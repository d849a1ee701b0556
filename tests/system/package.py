#!/usr/bin/python3
"""What others install: the CMake package with its example project, and the Debian package."""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys

from program import PROGRAM, ROOT, SystemTest, main, write_scenario

BUILD = pathlib.Path(PROGRAM).parent
PLAIN = {name: value for name, value in os.environ.items() if not name.startswith("FURROW")}


class Package(SystemTest):
    def run_here(self, *command):
        return self.call([*map(str, command)], env=PLAIN).stdout

    def test_the_example_project_is_built_on_an_installed_tree_and_runs(self):
        self.run_here("cmake", "--install", BUILD, "--prefix", "first")
        tree = self.folder / "moved tree"
        (self.folder / "first").rename(tree)
        for file in (tree / "lib" / "cmake" / "Furrow").iterdir():
            self.assertNotIn(str(ROOT), file.read_text(), file)
        self.run_here("cmake", "-S", tree / "share/furrow/example", "-B", "build", f"-DCMAKE_PREFIX_PATH={tree}")
        self.run_here("cmake", "--build", "build")
        out = self.run_here("build/sinkage")
        loads = [float(line.split(",")[1]) for line in out.splitlines() if re.match(r"-?\d", line)]
        self.assertGreater(len(loads), 3, out)
        self.assertEqual(loads[0], 0, "the tire begins above the bed")
        load = float(re.search(r"^load at 40 mm: (-?\d+) N$", out, re.MULTILINE)[1])
        self.assertTrue(100 < load < 1e5, out)
        done = subprocess.run(["build/sinkage", "none.json"], cwd=self.folder, text=True, capture_output=True)
        self.assertEqual((done.returncode, done.stderr),
                         (2, "sinkage: error: none.json: does not exist, expected a tire file in JSON\n"))

    def test_the_debian_package_says_what_it_needs_and_runs_from_where_it_is_unpacked(self):
        self.run_here("cpack", "--config", BUILD / "CPackConfig.cmake", "-G", "DEB", "-B", self.folder / "deb")
        file, = (self.folder / "deb").glob("*.deb")
        fields = dict(re.findall(r"^ ?(\S+): (.*)$", self.run_here("dpkg-deb", "-f", file), re.MULTILINE))
        self.assertEqual(fields["Package"], "furrow")
        # Ceres is linked statically
        for name in ("openmpi-bin", "libopenmpi3", "libc6", "libfmt9",
                     "libopenblas0", "libcholmod3", "libgoogle-glog0v6", "libcxsparse3", "libhdf5-103"):
            self.assertRegex(fields["Depends"], rf"(^|[ |]){re.escape(name)}")
        self.run_here("dpkg-deb", "-x", file, "root")
        usr = self.folder / "root" / "usr"
        self.assertIn("GNU GPL", (usr / "share/doc/furrow/copyright").read_text())
        self.assertFalse((usr / "include").exists(), "the libraries are no part of it")
        self.assertEqual(list(usr.rglob("libfurrow_liggghts*")), [],
                         "what links LIGGGHTS is under the GPL and a component of its own")
        for name in ("furrow/rigs/README.md", "furrow/scripts/docs/results.md",
                     "furrow/GLOSSARY.md", "man/man1/furrow.1", "bash-completion/completions/furrow",
                     "furrow/scripts/python/furrow/page/bundle/LICENSES.txt"):
            self.assertTrue((usr / "share" / name).is_file(), name)
        write_scenario(self.folder)
        self.run_here(usr / "bin/furrow", "run", "small.json", "--out", "out", "--set", "terrain.engine=rigid", "--set",
                      "run.end=0.004", "--set", "run.average_from=0", "--no-plots")
        if not (importlib.util.find_spec("matplotlib") and importlib.util.find_spec("h5py")):
            self.skipTest("needs python3-matplotlib and python3-h5py")
        self.run_here(usr / "bin/furrow", "report", "out")
        self.assertTrue((self.folder / "out" / "report.html").exists())
        shown = self.run_here("env", f"PYTHONPATH={usr}/lib/python3/dist-packages", f"PATH={usr}/bin:/usr/bin:/bin",
                              "/usr/bin/python3", "-B", "-c", "import furrow; print(furrow.open('out').state)")
        self.assertEqual(shown, "done\n")


if __name__ == "__main__":
    missing = [name for name in ("cmake", "cpack", "dpkg-deb", "dpkg-shlibdeps", "file") if not shutil.which(name)]
    if missing:
        print("needs", *missing)
        sys.exit(77)
    main()
