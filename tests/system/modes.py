#!/usr/bin/python3
"""`furrow modes`: what it prints and leaves, and what it refuses."""
import csv
import io
import json
import math

from program import ROOT, SystemTest, main, read_json, write_json


def rows(text):
    return list(csv.DictReader(io.StringIO(text)))


class Modes(SystemTest):
    def run_modes(self, *arguments, **expected):
        return self.furrow("modes", *arguments, **expected)

    def test_folder_holds_frequencies_shapes_and_pictures(self):
        done = self.run_modes("hmmwv_lumped.json", "--elements-circumference", "24", "--elements-width", "6",
                              "--orders", "3", "--count", "2", "--out", "out")
        out = self.folder / "out"
        self.assertEqual(done.stdout.strip(), "out")
        self.assertRegex(done.stderr, r"furrow: lowest frequency [\d.]+ Hz, of order \d\n")
        self.assertEqual({path.name for path in out.iterdir()} - {".furrow-run"},
                         {"modes.csv", "section.csv", "shapes.csv", "summary.json", "frequencies.png",
                          "mode_shapes.png", "mode_sections.png", "report.html"})
        summary = read_json(out / "summary.json")
        self.assertEqual([(mode["order"], mode["number"]) for mode in summary["modes"]],
                         [(order, number) for order in range(4) for number in (1, 2)])
        self.assertTrue(summary["stable"])
        self.assertEqual((summary["tire"], summary["pressure_Pa"], summary["sections"]),
                         ("hmmwv_lumped.json", 200e3, 24))
        table = rows((out / "modes.csv").read_text())
        for line, mode in zip(table, summary["modes"], strict=True):
            self.assertAlmostEqual(float(line["frequency_Hz"]), mode["frequency_Hz"], places=5)
            self.assertTrue(20 < mode["frequency_Hz"] < 400, mode)
        self.assertEqual(len(rows((out / "shapes.csv").read_text())), 8 * 7)
        self.assertEqual(len(rows((out / "section.csv").read_text())), 6)
        self.furrow("modes", "hmmwv_lumped.json", "--out", "out", code=2, says="out")

    def test_pressure_stiffens_and_what_is_printed_is_what_is_written(self):
        coarse = ("hmmwv_lumped.json", "--elements-circumference", "24", "--elements-width", "6", "--orders", "2")
        soft, hard = (rows(self.run_modes(*coarse, "--csv", "--pressure", pressure).stdout)
                      for pressure in ("1e5", "2e5"))
        for a, b in zip(soft, hard, strict=True):
            self.assertLess(float(a["frequency_Hz"]), float(b["frequency_Hz"]), a)
        printed = json.loads(self.run_modes(*coarse, "--json").stdout)
        self.assertEqual([f"{mode['frequency_Hz']:.9g}" for mode in printed["modes"]],
                         [line["frequency_Hz"] for line in hard])
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_wrinkles_are_named(self):
        done = self.run_modes("hmmwv_layered.json", "--orders", "24", "--count", "1",
                              "--json", says="furrow: warning: this tire is not stable at rest from order 23 on")
        self.assertFalse(json.loads(done.stdout)["stable"])

    def test_planar_tires(self):
        self.run_modes("aligator_planar.json", "--elements-circumference", "36", "--orders", "2", "--out", "out",
                       says="lowest frequency")
        self.assertFalse((self.folder / "out" / "mode_sections.png").exists())
        self.assertTrue((self.folder / "out" / "mode_shapes.png").exists())
        self.assertIsNone(self.summary()["pressure_Pa"])

    def test_flexible_rings(self):
        self.run_modes("hmmwv_ring.json", "--elements-circumference", "240", "--orders", "3", "--out", "out",
                       says="lowest frequency")
        self.assertTrue((self.folder / "out" / "mode_shapes.png").exists())
        summary = self.summary()
        self.assertEqual((summary["pressure_Pa"], summary["mass_kg"], summary["sections"]), (200e3, 11.5, 240))
        self.assertEqual([(mode["order"], mode["number"]) for mode in summary["modes"]],
                         [(order, number) for order in range(4) for number in (1, 2)])
        self.assertTrue(summary["stable"])
        # The belt turns on its rim with k_t alone: sqrt(2 pi k_t / belt mass) / (2 pi).
        tangential = read_json(ROOT / "tire/data/hmmwv_ring.json")["tangential"]
        self.assertAlmostEqual(summary["modes"][0]["frequency_Hz"],
                               (2 * math.pi * tangential / 8.207) ** 0.5 / (2 * math.pi), delta=0.01)

    def test_bad_input(self):
        (self.folder / "broken.json").write_text("{")
        write_json(self.folder / "other.json", {**read_json(ROOT / "tire/data/aligator_planar.json"), "radius": 0.1})
        for arguments, said in (
                ((), "TIRE is required"), (("none.json",), "key 'TIRE': 'none.json' does not exist"),
                (("broken.json",), "broken.json:1:2: is not valid JSON"),
                (("other.json",), "other.json: key 'rim_radius'"),
                (("hmmwv_ring.json", "--count", "3"),
                 "key '--count': is 3, expected 1 to 2, the unknowns of a section"),
                (("hmmwv_lumped.json", "--orders", "46"), "key '--orders': is 46, expected 0 to 45"),
                (("hmmwv_lumped.json", "--orders", "-1"), "key '--orders': is -1"),
                (("hmmwv_lumped.json", "--count", "0"), "key '--count': is 0, expected 1 to 138"),
                (("hmmwv_lumped.json", "--count", "1000"), "key '--count': is 1000"),
                (("hmmwv_lumped.json", "--pressure", "-1"), "key '--pressure': is -1"),
                (("hmmwv_lumped.json", "--pressure", "nan"), "key '--pressure': is nan"),
                (("aligator_planar.json", "--pressure", "1e5"),
                 "key '--pressure': is given, but a planar finite-element tire does not"),
                (("aligator_planar.json", "--elements-width", "6"), "key '--elements-width': is given"),
                (("hmmwv_lumped.json", "--elements-circumference", "3"),
                 "key 'elements_circumference': is 3, expected at least 8"),
                (("hmmwv_lumped.json", "--elements-circumference", "1000000"),
                 "key '--elements-circumference': is 1000000"),
                (("hmmwv_lumped.json", "--csv", "--json"), "excludes"),
                (("hmmwv_lumped.json", "--csv", "--out", "x"), "excludes")):
            before = set(self.folder.iterdir())
            self.furrow("modes", *arguments, code=2, says=said)
            self.assertEqual(set(self.folder.iterdir()), before)


if __name__ == "__main__":
    main()
