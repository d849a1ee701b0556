#!/usr/bin/python3
"""How stiff the layer of hard ground has to be, so that a tire over a narrow cleat has the force of `furrow press`.

    /usr/bin/python3 tests/studies/cleat_ground.py

The planar tire of cleat_roll.py rolls at 0.5 m/s and without friction over its cleat, 20 mm high and 25 mm long, with
its axle held, on layers of 4e8 N/m³, the default, times FACTORS; the step becomes smaller as the layer becomes stiffer,
and the layer's damper keeps its share of the critical one. Beside it is the press on the same profile at the same
height of the axle, in which the ground does not give. Writes cleat_ground.csv beside this script: the ground's vertical
force with the cleat's middle under the axle and 120 mm from there, and both over that of the press.
"""
import math

import numpy as np

import driver
import provenance
from cleat_roll import HEIGHTS, RESULTS, SLOW, Passage, fitted_planar, scenario, statically

FACTORS = (0.25, 1.0, 4.0, 16.0)
LAYER, DAMPING = 4e8, 2e4  # N/m³, N s/m³
PLACES = (0.0, 0.12)  # m


def rows_of(factor):
    made = scenario("planar", SLOW, HEIGHTS[0], friction=0.0)
    made["terrain"] |= {"ground_stiffness": factor * LAYER, "ground_damping": math.sqrt(factor) * DAMPING}
    made["run"]["step"] = 2e-5 / max(1.0, 2.0 ** math.ceil(0.5 * math.log2(factor)))
    slow = Passage(driver.kept(RESULTS / f"planar_ground_{factor:g}", "run", scenario=made), SLOW)
    for place in PLACES:
        # The press depends on the height at which the axle is held, and that a little on the layer.
        still = statically(slow.height, HEIGHTS[0], place)
        found = float(np.mean([np.interp(side * place, slow.way, slow.ground["z"]) for side in (-1.0, 1.0)]))
        yield {"ground_stiffness_N_per_m3": f"{factor * LAYER:g}", "step_s": f"{made['run']['step']:g}",
               "place_mm": f"{1e3 * place:.0f}", "run_N": f"{found:.0f}", "press_N": f"{still:.0f}",
               "beside": f"{found / still - 1.0:.4f}"}


def main():
    driver.options(__doc__).parse_args()
    made = provenance.made_here()
    fitted_planar()
    driver.write("cleat_ground.csv", [row for factor in FACTORS for row in rows_of(factor)], made, told=True)


if __name__ == "__main__":
    main()
