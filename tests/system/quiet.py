#!/usr/bin/python3
"""`--quiet`, which means the same of every command: nothing but errors on standard error, the same result on standard
output."""
import json
import re
import subprocess

from program import ROOT, SystemTest, changed, furrow, main, on_terminal, write_json, write_scenario

PRESSED = changed(rig={"slip": 0.1, "ramp": 0.1},
                  tire={"file": "hmmwv_lumped.json", "rigid": False, "elements_circumference": 30, "elements_width": 6})
WITH_QUIET = ("run", "resume", "sweep", "calibrate", "bed", "soil", "press",
              "modes", "kc", "report", "validate", "ranks", "new")
TIMES = ("wall_s", "settle_wall_s", "from_cache", "ms", "_per_s", "_ms")  # keys whose values differ from time to time


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(held) for key, held in value.items()
                if not key.endswith(TIMES) and key not in ("parts_ms", "ms_per_step", "ns_per_contact")}
    return value


class Quiet(SystemTest):
    def setUp(self):
        super().setUp()
        self.env = {"XDG_CACHE_HOME": str(self.folder / "cache")}

    def both(self, *arguments, says=True):
        """What it prints without and with --quiet."""
        loud = self.furrow(*arguments, env=self.env)
        if says:
            self.assertNotEqual(loud.stderr, "", "it has something to say")
        quiet = furrow(*arguments, "--quiet", cwd=self.folder, env=self.env)
        self.assertEqual((quiet.returncode, quiet.stderr), (0, ""))
        return loud.stdout, quiet.stdout

    def test_every_command_that_tells_more_than_its_result_has_it(self):
        for command in (*WITH_QUIET, "bench grains", "bench tire", "bench rig"):
            done = furrow(*command.split(), "--help", cwd=self.folder)
            self.assertIn("Print errors only on standard error", " ".join(done.stdout.split()), command)

    def test_a_run_its_continuation_and_its_report(self):
        path = write_scenario(self.folder)
        loud, quiet = self.both("run", path, "--no-plots")
        self.assertEqual((loud, quiet), ("results/small-001\n", "results/small-002\n"))
        self.both("resume", "results/small-001", "--no-plots")
        self.assertEqual(len(set(self.both("report", "results/small-001"))), 1)
        self.furrow("resume", "results/small-001", "--until", "0.06", "--no-plots", "--quiet", env=self.env,
                    matches="^$", prints="results/small-001\n")

    def test_a_report_says_how_far_it_is_unless_it_is_quiet(self):
        self.furrow("run", write_scenario(self.folder), "--out", "out", "--no-plots", env=self.env)
        code, text = on_terminal("report", "out", "--vtk", "vtk", cwd=self.folder, env=self.env)
        self.assertEqual(code, 0, text)
        self.assertIn("\rfurrow: writing the frames", text)
        self.assertIn("\nvtk/terrain.pvd\n", text.replace("\r\033[K", "\n"))
        shares = [int(share) for share in re.findall(r"furrow: plotting (\d+) %", text)]
        self.assertGreater(len(shares), 1, text)
        self.assertEqual(shares, sorted(shares))
        done = subprocess.run(["/usr/bin/python3", "-B", ROOT / "scripts" / "python" / "furrow", "frames_vtk", "--out",
                               "more", "--progress", "out"], cwd=self.folder, text=True, capture_output=True)
        shares = [float(line.split()[1]) for line in done.stdout.splitlines() if line.startswith("progress ")]
        self.assertEqual((len(shares), shares[0], shares), (6, 0.0, sorted(shares)), done)
        self.assertRegex(text, r"plotting \d+ %   \d+:\d\d left")
        self.assertTrue(text.endswith("out/report.html\n"), text)
        code, text = on_terminal("report", "out", "--quiet", cwd=self.folder, env=self.env)
        self.assertEqual((code, {line.split("/")[0] for line in text.splitlines()}), (0, {"out"}), text)

    def test_several_beds_and_a_study(self):
        write_scenario(self.folder)
        self.both("run", "small.json", "--seeds", "2", "--out", "beds", "--no-plots")
        write_json(self.folder / "study.json", {"format_version": 1, "scenario": "small.json",
                                                            "grid": {"rig.slip": [0.1, 0.2]}})
        self.furrow("sweep", "study.json", "--quiet", env=self.env, matches="^$", prints="results/study\n")

    def test_a_bed(self):
        path = write_scenario(self.folder)
        loud, quiet = map(json.loads, self.both("bed", path))
        self.assertEqual(without_times(loud), without_times(quiet))

    def test_soil_tests(self):
        loud, quiet = map(json.loads, self.both("soil", write_scenario(self.folder), "--quick", "--only", "repose"))
        self.assertEqual(loud["repose"], quiet["repose"])

    def test_pressing(self):
        self.assertEqual(self.both("press", write_scenario(self.folder, PRESSED), "--points", "2"),
                         ("results/small-press-001\n", "results/small-press-002\n"))

    def test_frequencies(self):
        self.assertEqual(self.both("modes", "aligator_planar.json", "--orders", "1", "--no-plots"),
                         ("results/aligator_planar-modes-001\n", "results/aligator_planar-modes-002\n"))

    def test_suspensions(self):
        self.assertEqual(self.both("kc", ROOT / "vehicle" / "data" / "rover.json", "--points", "3",
                                   "--no-plots", says=False), ("results/rover-kc-001\n", "results/rover-kc-002\n"))

    def test_benchmarks(self):
        loud, quiet = map(json.loads, self.both("bench", "tire", "--elements-circumference",
                                                "24", "--elements-width", "6", "--warm", "0.02",
                                                "--steps", "60", "--step", "1e-4"))
        self.assertEqual(loud["state_hash"], quiet["state_hash"])

    def test_errors_and_how_to_continue_are_said(self):
        self.furrow("run", "none.json", "--quiet", code=2, matches="^furrow: error: ")
        failing = changed(run={"step": 2e-3}, terrain={"allow_unstable_step": True, "young_modulus": 1e8},
                          output={"series_interval": 4e-3})
        done = furrow("run", write_scenario(self.folder, failing), "--quiet", cwd=self.folder, env=self.env)
        self.assertNotEqual(done.returncode, 0)
        self.assertTrue(done.stderr.startswith("furrow: error: "), done.stderr)
        self.assertNotIn("warning", done.stderr)
        self.assertRegex(done.stderr, "start again with furrow run|furrow resume")


if __name__ == "__main__":
    main()
