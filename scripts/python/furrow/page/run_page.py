"""The page of a run: the answer in words, its curves, rut, accounts, ranks, scenario and provenance."""
import re

from ..plot import events
from ..plot.chart_table import ACCOUNTS, VEHICLE, WHEEL
from ..plot.digits import digits
from ..plot.run_data import Missing, printable
from ..plot.vehicle_run import VehicleRun
from ..plot.units import is_number, naming

from . import blocks, curves, ground, scenario

# Keys of a wheel that become cards: (key, its standard error, how many independent values).
CARDS = (("sinkage_m", "sinkage_sem_m", "sinkage_n_eff"), ("rut_depth_m", "rut_depth_sem_m", "rut_depth_n_eff"),
         *((key, None, None) for key in ("drawbar_coefficient", "vertical_load_N", "tire_deflection_m",
                                         "drive_torque_Nm", "tractive_efficiency")))
EXPECTED = (("drawbar_pull", "drawbar_pull_N"), ("sinkage", "sinkage_m"), ("rut_depth", "rut_depth_m"))
OF_WHEELS = ("slip", "vertical_force_N", "tractive_effort_N", "terrain_resistance_N", "drive_torque_Nm", "sinkage_m",
             "rut_depth_m", "lateral_force_N", "tire_deflection_m", "tractive_efficiency")
PROVENANCE = ("version", "scenario", "scenario_digest", "state_hash", "format_version", "compiler", "cpu",
              "terrain_engine", "law", "simulated_s", "wall_s", "settle_wall_s", "wall_s_per_simulated_s", "grains",
              "contacts_mean", "active_share_mean", "substeps_added", "substeps_refined_share", "substeps_most_parts")

STATES = ("gear", "shifting")  # whose means are no gear
CHANGING = 0.05  # m/s²: a mean acceleration beyond it is no steady drive


def window_of(run):
    """The averaging window, s; of runs without a pull, from average_from to the end."""
    if run.window:
        return list(run.window)
    section = run.scenario.get("run") or {}
    if run.summary and is_number(section.get("average_from")) and is_number(run.summary.get("simulated_s")):
        return [section["average_from"], run.summary["simulated_s"]]
    return None


def all_rigid(run):
    """Whether no tire deflects: what its mesh, a polygon, leaves of a deflection is not shown."""
    return all(tire.get("rigid") for tire in run.scenario.get("tires") or [run.scenario.get("tire") or {}])


def hard_ground(run):
    """Whether nothing sinks into the ground."""
    return run.told.get("terrain_engine") == "rigid"


def pull_words(run, pull):
    """Sentences on the pull, its interval, and whether it is steady."""
    half = blocks.half_95(pull.get("sem"), pull.get("n_eff"))
    value, _ = blocks.quantity("pull_N", pull["mean"], half)
    slip = f" at {100 * run.number('slip'):g} % slip" if is_number(run.number("slip")) else ""
    who = f"Wheel 0 of {len(run.wheels)}" if len(run.wheels) > 1 else "The tire"
    words = f"{who} pulls {value} N{slip}"
    if half is not None:
        words += (f" (95 % interval; standard error {digits(pull['sem'])} N from about {pull['n_eff']:.0f} independent "
                  f"values)")
    words += f", as the mean from {run.window[0]:.3g} to {run.window[1]:.3g} s." if run.window else "."
    return words


def steady_words(pull):
    """(kind, sentence)."""
    if pull.get("steady"):
        details = []
        if is_number(pull.get("drift_N_per_s")) and is_number(pull.get("drift_t")):
            details.append(f"the drift of {digits(pull['drift_N_per_s'])} N/s is {abs(pull['drift_t']):.2g} times its "
                           f"standard error")
        if is_number(pull.get("halves_differ_N")):
            details.append(f"the halves of the window differ by {digits(pull['halves_differ_N'])} N")
        return "good", ("Steady: within the averaging window the pull neither drifts nor changes between its halves by "
                        "more than its own noise" + (f" ({'; '.join(details)})" if details else "")
                        + ". A longer window would give the same mean within the interval.")
    reasons = "; ".join(map(printable, pull.get("unsteady_because")
                            or ["the averaging window is not long or even enough"]))
    return "warn", (f"Not steady: {reasons}. The mean depends on where the averaging window lies, and the interval is "
                    f"too small. "
                    "Run longer, or average later (run.end, run.average_from), before you quote this number.")


def step_answer(run):
    """What the run's verdict on its communication step says, where that is not good."""
    judged = run.summary.get("interface") or {}
    if judged.get("ok") is not False or not is_number(judged.get("share")):
        return []
    return [blocks.text(f"The step is too large: forces that come one step late make or take "
                        f"{100 * judged['share']:.3g} % of the work that passes a wheel, expected at most 1 %. Take a "
                        f"run.step of {digits(judged.get('better_step_s'))} s or less before you quote this result.",
                        "warn")]


def pull_answer(run):
    pull = run.summary.get("drawbar_pull_N") or {}
    if not is_number(pull.get("mean")):
        return []
    if not run.measured:
        return [blocks.text("The tire did not touch the ground in the averaging window: nothing was measured.", "warn")]
    kind, words = steady_words(pull)
    return [blocks.text(pull_words(run, pull), "lead"), blocks.text(words, kind),
            blocks.text("The interval holds for this bed of grains: it covers the noise within this run, not the "
                        "scatter between beds. "
                        "'furrow run SCENARIO --seeds N' gives the mean over N beds and its interval.", "note")]


def answer_cards(run):
    summary, items = run.summary, []
    pull = summary.get("drawbar_pull_N") or {}
    if is_number(pull.get("mean")) and run.measured:
        half = blocks.half_95(pull.get("sem"), pull.get("n_eff"))
        value, unit = blocks.quantity("drawbar_pull_N", pull["mean"], half)
        items.append(blocks.card("drawbar pull", value, unit, "95 %" if half is not None else "",
                                 "good" if pull.get("steady") else "warn",
                                 "steady" if pull.get("steady") else "not steady"))
    hard, rigid = hard_ground(run), all_rigid(run)
    for key, sem, count in CARDS:
        if not is_number(summary.get(key)) or (hard and key == "sinkage_m") or (rigid and key == "tire_deflection_m"):
            continue
        half = blocks.half_95(summary.get(sem), summary.get(count), blocks.LEAST_SAMPLES) if sem else None
        value, unit = blocks.quantity(key, summary[key], half)
        few = f"no error: fewer than {blocks.LEAST_SAMPLES} independent values" if sem and half is None else ""
        items.append(blocks.card(naming(key)[0], value, unit, "95 %" if half is not None else "", explanation=few))
    return items


def vehicle_answer(run):
    """Means over the averaging window of what drives on several wheels."""
    made = []
    for subject, values in (run.summary.get("subjects") or {}).items():
        rows = []
        for key, value in (values if isinstance(values, dict) else {}).items():
            if is_number(value) and key not in STATES:
                words, unit, _ = naming(key)
                rows.append([words, blocks.quantity(key, value)[0], unit])
        if rows:
            speed, load = values.get("speed_m_s"), values.get("wheel_power_W")
            if is_number(speed):
                made.append(blocks.text(f"In the averaging window the {subject} drives at {digits(speed)} m/s on "
                                        "average" + (f"; {digits(1e-3 * load)} kW reach its wheels." if is_number(load)
                                                     else "."), "lead"))
            change = values.get("acceleration_m_per_s2")
            if is_number(change) and abs(change) > CHANGING:
                made.append(blocks.text(f"The {subject} is not in a steady state: on average its speed changes by "
                                        f"{digits(change)} m/s each second. "
                                        "Means over the window describe this stretch, not a constant speed.", "warn"))
            made.append({"type": "fold", "title": f"All means of the {subject} in the averaging window",
                         "blocks": [blocks.table(["quantity", "mean", "unit"], rows)]})
    return made


def vertical_force(wheel):
    """Mean over the window, N; None where the summary lacks it."""
    force = wheel.get("net_terrain_force_N")
    return force[2] if isinstance(force, list) and len(force) == 3 else None


def wheels_table(run):
    wheels = [{**wheel, "vertical_force_N": vertical_force(wheel)}
              for wheel in run.summary.get("wheels") or [] if isinstance(wheel, dict)]
    names = [name for name in OF_WHEELS if any(is_number(wheel.get(name)) for wheel in wheels)
             and not (name == "tire_deflection_m" and all_rigid(run))
             and not (name == "sinkage_m" and hard_ground(run))]
    if len(wheels) < 2 or not names:
        return []
    columns = ["wheel"] + [", ".join(filter(None, (words, unit.replace(" ", "\u00a0")))) for words,
                           unit, _ in map(naming, names)]
    who = [name.replace("_", " ") for name in run.wheel_names] or [str(k) for k in range(len(wheels))]
    rows = [[who[k]] + [blocks.quantity(name, wheel.get(name))[0] for name in names] for k, wheel in enumerate(wheels)]
    return [blocks.table(columns, rows, note="Means over the averaging window.")]


def regressions_table(run):
    """What published regressions expect of the only wheel, those that do not hold here apart."""
    found = run.summary.get("regressions")
    if not isinstance(found, dict) or len(run.summary.get("wheels") or []) > 1:
        return []
    rows = []
    for of in found.values():
        if isinstance(of, dict):
            because = "; ".join(map(printable, of.get("out_of_range_because") or []))
            numbers = [digits(of[key]) if is_number(of.get(key)) else "–"
                       for key in ("gross_N", "resistance_N", "net_N", "slip")]
            rows.append([str(of.get("name")), *numbers, str(of.get("range")),
                         "in range" if of.get("in_range") else f"out of range: {because}"])
    return [{"type": "fold", "title": "Published regressions of traction at this cone index", "blocks": [
        blocks.table(["regression", "gross, N", "resistance, N", "net, N", "its slip", "made for", ""], rows,
                     note=f"At a cone index of {digits(1e-3 * found['cone_index_Pa'])} kPa. Regressions of sand count "
                          "the slip from rolling without torque, the others from no pull on hard ground. Formulas and "
                          "sources: scripts/docs/results.md, \"Regressions\".")]}]


def expected_table(run):
    expected = run.scenario.get("expected")
    if not isinstance(expected, dict):
        return []
    rows, outside = [], 0
    for key, result in EXPECTED:
        value = run.summary.get(result)
        value = value.get("mean") if isinstance(value, dict) else value
        target, spread = expected.get(key), expected.get(f"{key}_spread")
        if not is_number(target) or not is_number(value):
            continue
        verdict = "no spread stated"
        if is_number(spread):
            verdict = "within the spread" if abs(value - target) <= spread else "outside of the spread"
            outside += abs(value - target) > spread
        words, unit, _ = naming(result)
        rows.append([words, *(blocks.quantity(result, v)[0] for v in (value, target, spread)), unit, verdict])
    if not rows:
        return []
    words = ("This run is within what the scenario's author expects." if not outside
             else "This run differs from what the scenario's author expects. Keys that you changed may be the reason.")
    return [blocks.text(words, "warn" if outside else "good"),
            blocks.table(["quantity", "this run", "expected", "± spread between beds", "unit", ""], rows)]


def answer(run):
    failed = run.failed.get("failed")
    made = []
    if isinstance(failed, dict):
        made.append(blocks.text(f"The run failed at t = {failed.get('time_s')} s: {failed.get('error')}.", "bad"))
        made.append(blocks.text("Everything below is what it left until then. There are no means and no intervals.",
                                "note"))
    elif not run.summary:
        made.append(blocks.text("This run has no summary: it is still running, or it was stopped before its end.",
                                "warn"))
    made += step_answer(run) + pull_answer(run)
    if len(run.summary.get("wheels") or []) < 2 and (items := answer_cards(run)):
        if not run.summary.get("drawbar_pull_N"):
            window = window_of(run)
            span = f" from {window[0]:.3g} to {window[1]:.3g} s" if window else ""
            made.append(blocks.text(f"The figures are means over the averaging window{span}. This rig measures no "
                                    f"drawbar pull.", "lead"))
        made.append(blocks.cards(items))
    made += vehicle_answer(run) + wheels_table(run) + regressions_table(run) + expected_table(run)
    for what, found in (run.summary.get("accounts") or {}).items():
        if isinstance(found, dict) and found.get("closes") is False:
            made.append(blocks.text(f"The account of {what} does not close. The result may be wrong: see Accounts.",
                                    "bad"))
    return {"id": "answer", "title": "Result", "blocks": made}


def wheel_tables(run):
    """Names of the tables of the wheels by number."""
    names = {int(m[1]): p.name for p in run.directory.glob("timeseries_wheel*.csv")
             if (m := re.match(r"timeseries_wheel(\d+)\.csv$", p.name))}
    return {0: "timeseries.csv"} if (run.directory / "timeseries.csv").is_file() else dict(sorted(names.items()))


def series(run, arrays):
    window = window_of(run)
    names = wheel_tables(run)
    if not names:
        raise Missing("there is no table of a wheel")
    tables = {k: curves.Table(run, name, arrays) for k, name in list(names.items())[:curves.MOST_WHEELS]}
    made = []
    if len(tables) == 1:
        (table,) = tables.values()
        pull = run.summary.get("drawbar_pull_N") or {}
        levels = {}
        if is_number(pull.get("mean")) and run.measured:
            half = blocks.half_95(pull.get("sem"), pull.get("n_eff"))
            levels["drawbar_pull_N"] = [{"y": pull["mean"], "half": half, "label": "mean and 95 % interval"}]
        shown = [chart for key, chart in WHEEL.items() if run.told.get("grains") or key != "awake"]
        made.append(blocks.charts(curves.over_time(table, shown, window, levels), table.note))
    else:
        table = next(iter(tables.values()))
        more = f" The first {curves.MOST_WHEELS} of {len(names)} wheels are drawn." if len(names) > len(tables) else ""
        who = [name.replace("_", " ") for name in run.wheel_names]
        made.append(blocks.charts(curves.over_wheels(tables, window, who, hard_ground(run)), table.note + more))
    made.append(curves.explorer(table, window))
    shaded = "Shaded: the averaging window. " if window else ""
    made.insert(0, blocks.text(shaded + "Drag across a plot to zoom, double-click to see all. Click a name in the "
                               "legend to hide its curve.", "note"))
    return {"id": "series", "title": "Curves", "blocks": list(filter(None, made))}


def vehicle_series(run, arrays):
    table = curves.Table(run, "timeseries_vehicle.csv", arrays)
    made = [blocks.charts(curves.over_time(table, VEHICLE.values(), window_of(run)), table.note)]
    if "x_m" in table.columns and "y_m" in table.columns:
        x, y = (arrays.add(table.columns[name]) for name in ("x_m", "y_m"))
        made[0]["charts"].insert(0, blocks.chart("Path from above", "x",
                                                 "m", "m", [{"label": "chassis", "x": x, "y": y, "style": "line"}]))
    made.append(curves.explorer(table, window_of(run)))
    return {"id": "vehicle", "title": "Vehicle", "blocks": list(filter(None, made))}


def happened(run):
    """The events of `furrow events`."""
    found = events.events(VehicleRun(run))
    rows = [[f"{e.time:.3f}", e.what, e.subject, f"{events.significant(float(e.value))} {e.unit}".rstrip(), e.threshold]
            for e in found]
    return {"id": "events", "title": "Events", "blocks": [
        blocks.table(["time, s", "what", "of", "value", "threshold"], rows,
                     note="From the time series alone, as 'furrow events' lists them with the means of the axles.")]}


def energy_rows(energy):
    rows = []
    for group in ("work", "stored", "lost"):
        for name, value in (energy.get(group) or {}).items():
            if is_number(value):
                rows.append([group, ACCOUNTS[group].lines.get(f"{name}_J", name.replace("_", " ")), digits(value)])
    return rows


def accounts(run, arrays):
    made = []
    found = run.told.get("accounts") or {}
    for what in ("energy", "momentum"):
        account = found.get(what)
        if isinstance(account, dict) and isinstance(account.get("closes"), bool):
            share = account.get("residual_share")
            whole = "what was turned over" if what == "energy" else "the largest impulse"
            size = f" {digits(100 * abs(share))} % of {whole} is not accounted for." if is_number(share) else ""
            closes = account["closes"]
            made.append(blocks.text(f"The account of {what} {'closes' if closes else 'does not close'}.{size}",
                                    "good" if closes else "bad"))
    energy = found.get("energy")
    if isinstance(energy, dict) and (rows := energy_rows(energy)):
        made.append({"type": "fold", "title": "The terms of the energy account",
                     "blocks": [blocks.table(["", "term", "J"], rows, note="Over the whole run.")]})
    try:
        table = curves.Table(run, "timeseries_accounts.csv", arrays)
    except Missing:
        table = None
    if table:
        made.append(blocks.charts(curves.over_time(table, ACCOUNTS.values(), window_of(run)), table.note))
        made.append(curves.explorer(table, window_of(run)))
    return {"id": "accounts", "title": "Accounts", "blocks": list(filter(None, made))}


def rut(run, arrays):
    if not run.told.get("grains") and (profile := ground.unchanged(run, arrays)):
        return {"id": "rut", "title": "Ground", "blocks": [blocks.charts([profile])]} if profile["lines"] else None
    return {"id": "rut", "title": "Rut", "blocks": [blocks.text("Height of the surface after the run, against that "
                                                                "before it. Move over the map for values, click for "
                                                                "cross-sections.", "note"), ground.rut(run, arrays)]}


def ranks(run):
    rows, lines = [], []
    found = [rank for rank in run.told.get("ranks") or [] if isinstance(rank, dict)]
    if not found:
        raise Missing("the summary names no ranks")
    keys = [key for key in found[0] if key not in ("rank", "node", "busy_share")]
    for rank in found:
        share = rank.get("busy_share")
        label = f"{rank.get('rank')} · {rank.get('node')}"
        rows.append((label, share if is_number(share) else 0.0,
                     f"{100 * share:.0f} % busy" if is_number(share) else "unknown"))
        lines.append([label] + [digits(rank[key]) if isinstance(rank.get(key), float)
                                else str(rank.get(key, "–")) for key in keys])
    busiest = max(rows, key=lambda row: row[1])
    words = (f"Rank {busiest[0]} sets the pace: it computes {100 * busiest[1]:.0f} % of the time. The others wait for "
             f"it the rest of the time.")
    return {"id": "ranks", "title": "Ranks",
            "blocks": [blocks.text(words), blocks.bars(rows, "Share of the wall time in which a rank computes."),
                       blocks.table(["rank"] + [", ".join(filter(None, naming(key)[:2])) for key in keys], lines)]}


def provenance(run):
    summary = run.told
    rows = [(key, summary[key]) for key in PROVENANCE if isinstance(summary.get(key), (str, int, float))]
    if run.scenario.get("completed_by"):
        rows.append(("scenario completed by", str(run.scenario["completed_by"])))
    segments = [s for s in summary.get("segments") or [] if isinstance(s, dict)]
    for segment in segments if len(segments) > 1 else []:
        rows.append(("segment", f"steps {segment.get('from_step')} to {segment.get('to_step')}, "
                     f"{segment.get('threads')} threads, {segment.get('wall_s')} s"))
    if not rows:
        raise Missing("there is no summary")
    rows.append(("folder", run.directory.name))
    return {"id": "provenance", "title": "Provenance", "blocks": [blocks.values_table(rows)]}


def badges(run):
    pull = run.summary.get("drawbar_pull_N") or {}
    if run.failed:
        return [{"text": "failed", "kind": "bad"}]
    if not run.summary:
        return [{"text": "not finished", "kind": "warn"}]
    if is_number(pull.get("mean")):
        return [{"text": "steady", "kind": "good"} if pull.get("steady") else {"text": "not steady", "kind": "warn"}]
    return []


def fill(page, arrays, run, sections):
    page["title"] = run.title if run.summary else str(run.failed.get("scenario") or run.directory.name)
    page["badges"] = badges(run)
    if run.cut_short:
        page["left_out"].append(f"curves: {run.cut_short}.")
    sections(page, [
        ("result", lambda: answer(run)),
        ("curves of the vehicle", lambda: vehicle_series(run, arrays)
         if (run.directory / "timeseries_vehicle.csv").is_file() else None),
        ("events", lambda: happened(run) if run.has_vehicle else None),
        ("curves", lambda: series(run, arrays)),
        ("rut", lambda: rut(run, arrays)),
        ("accounts", lambda: accounts(run, arrays)),
        ("ranks", lambda: ranks(run)),
        ("scenario", lambda: scenario.section(run.scenario) if run.scenario else None),
        ("provenance", lambda: provenance(run)),
    ])
