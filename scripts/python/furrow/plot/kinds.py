"""What tells the kinds of folders apart, and the pictures that each kind has, by the names of their files."""
import functools

from . import (accounts, calibrate, charts, ground, kinematics, modes, press, ride, scene, soil, sweep, vehicle_ground,
               vehicle_plots, vehicle_run, vehicle_scene, wheels)
from .run_data import Run, kind_of

READERS = {"calibration": calibrate.Calibration, "soil": soil.Soil, "sweep": sweep.Sweep, "press": press.Press,
           "modes": modes.Modes, "kinematics": kinematics.Kinematics, "run": Run}


@functools.lru_cache(maxsize=1)
def vehicle_of(run):
    return vehicle_run.VehicleRun(run)


def of_vehicle(plot):
    """A plot of a vehicle's run, for `Run`."""
    return functools.wraps(plot)(lambda run: plot(vehicle_of(run)))


def named(*plots):
    return {plot.__name__: plot for plot in plots}


ACCOUNTS = (charts.ranks, accounts.energy, accounts.momentum)
RUN = {**named(charts.pull_slip_sinkage, charts.forces, ground.rut, *ACCOUNTS), "scene": scene.scene}
RIDE = {**RUN, "ride": ride.ride}
VEHICLE = {**named(*map(of_vehicle, (vehicle_plots.vehicle, wheels.wheel_forces, wheels.wheel_motion,
                                     wheels.front_and_rear, vehicle_plots.path, vehicle_plots.gear,
                                     vehicle_ground.rut)), *ACCOUNTS),
           "scene": of_vehicle(vehicle_scene.vehicle_scene)}
CURVE, BEDS = named(sweep.curve), named(sweep.beds)
PASSES = named(sweep.curve, sweep.passes, sweep.rut_along)
OTHERS = {calibrate.Calibration: named(calibrate.fit, calibrate.residual),
          soil.Soil: named(soil.plate, soil.shear, soil.cone, soil.repose),
          press.Press: named(press.load_deflection, press.footprint),
          modes.Modes: named(modes.frequencies, modes.mode_shapes, modes.mode_sections),
          kinematics.Kinematics: named(kinematics.parallel, kinematics.opposite, kinematics.steering)}
ALL = {name: plot for plots in (VEHICLE, RIDE, PASSES, BEDS, *OTHERS.values()) for name, plot in plots.items()}


def opened(directory):
    return READERS[kind_of(directory)](directory)


def plots_of(run):
    if isinstance(run, Run):
        return VEHICLE if run.has_vehicle else RIDE if ride.COLUMN in run.series else RUN
    if isinstance(run, sweep.Sweep):
        return BEDS if run.values.get("beds") else PASSES if run.values.get("passes") else CURVE
    return OTHERS[type(run)]
