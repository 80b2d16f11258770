"""Tests of what needs no build: runs that are kept, and the page that is written from them."""

import json
import tempfile
import unittest
from pathlib import Path

import processor
import report
import results
from programs import PROGRAMS
from requirements import outcomes

XEON = "Intel(R) Xeon(R) Processor @ 2.50GHz"


def cpuinfo(vendor: str, family: int, model: int, stepping: int, brand: str, flags: str = "") -> str:
    return (
        f"processor\t: 0\nvendor_id\t: {vendor}\ncpu family\t: {family}\nmodel\t\t: {model}\nmodel name\t: {brand}\n"
        f"stepping\t: {stepping}\nflags\t\t: {flags}\n\nprocessor\t: 1\nmodel\t\t: 0\n"
    )


def run(name: str, date: str, times: dict[str, list[float]]) -> dict:
    return {"processor": {"name": name, "brand": name, "features": []}, "date": date, "partial": False, "times": times}


class Processors(unittest.TestCase):
    def test_a_name_is_the_plain_brand_with_the_microarchitecture(self):
        def name(*numbers) -> str:
            return processor.described(cpuinfo(*numbers))["name"]

        self.assertEqual(name("GenuineIntel", 6, 85, 4, XEON), "Intel Xeon (Skylake-SP)")
        self.assertEqual(name("GenuineIntel", 6, 85, 7, XEON), "Intel Xeon (Cascade Lake)")
        self.assertEqual(name("GenuineIntel", 6, 85, 10, XEON), "Intel Xeon (Cooper Lake)")
        self.assertEqual(name("AuthenticAMD", 26, 2, 1, "AMD EPYC"), "AMD EPYC (Zen 5)")
        self.assertEqual(name("AuthenticAMD", 25, 17, 1, "AMD EPYC 9354 32-Core Processor"), "AMD EPYC 9354 (Zen 4)")
        self.assertEqual(name("GenuineIntel", 6, 9999, 0, "Intel(R) New(TM) CPU"), "Intel New")
        self.assertEqual(name("GenuineIntel", 6, 167, 1, XEON), "Intel Xeon (Rocket Lake)")
        self.assertEqual(name("GenuineIntel", 6, 167, 1, XEON, "fpu amx_tile"), "Intel Xeon (Sapphire Rapids or later)")
        arm = processor.described("CPU implementer\t: 0x41\nCPU part\t: 0xd0c\nFeatures\t: fp asimd\n")
        self.assertEqual((arm["name"], arm["features"]), ("Neoverse N1", ["asimd"]))

    def test_x86_64_v3_needs_avx2_fma_and_what_comes_with_them(self):
        flags = "avx avx2 bmi1 bmi2 f16c fma abm movbe xsave"
        self.assertTrue(processor.runs_v3(cpuinfo("GenuineIntel", 6, 85, 7, XEON, flags)))
        self.assertFalse(processor.runs_v3(cpuinfo("GenuineIntel", 6, 85, 7, XEON, flags.replace("fma ", ""))))

    def test_several_states_are_computed_by_vectors_that_the_processor_has(self):
        def lanes(flags: str) -> list[str]:
            text = cpuinfo("AuthenticAMD", 25, 1, 1, "AMD EPYC", flags)
            return [p.key for p in PROGRAMS if p.ours and p.lanes > 1 and p.runs_on(text)]

        self.assertEqual(lanes("avx2 fma avx512f"), ["f64x8", "f32x16"])
        self.assertEqual(lanes("avx2 fma"), ["f64x4", "f32x8"])


class Runs(unittest.TestCase):
    def test_a_run_replaces_that_of_the_same_processor_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            for name, date, time in [("A", "2026-01-01", 1.0), ("B", "2026-01-02", 2.0), ("A", "2026-01-03", 3.0)]:
                results.save(run(name, date, {"native_f64 kr5 inverse": [time]}), folder)
            runs = results.load(folder)
        kept = [(r["processor"]["name"], r["date"]) for r in runs]
        self.assertEqual(kept, [("A", "2026-01-03"), ("B", "2026-01-02")])
        page = report.text(runs)
        self.assertIn("## A, 2026-01-03", page)
        self.assertIn("## B, 2026-01-02", page)
        self.assertNotIn("2026-01-01", page)

    def test_a_part_stands_beside_the_run_on_all_robots_until_the_next_of_these(self):
        def titles(runs: list[dict]) -> list[str]:
            return [line for line in report.text(runs).splitlines() if line.startswith("## A")]

        part = {**run("A", "2026-01-02", {"native_f64 anymal inverse": [2.0]}), "partial": True, "part": "free bases"}
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            results.save(run("A", "2026-01-01", {"native_f64 kr5 inverse": [1.0]}), folder)
            results.save(part, folder)
            self.assertEqual(titles(results.load(folder)), ["## A, 2026-01-01", "## A, free bases, 2026-01-02"])
            results.save({**part, "date": "2026-01-03"}, folder)
            self.assertEqual(titles(results.load(folder)), ["## A, 2026-01-01", "## A, free bases, 2026-01-03"])
            results.save(run("A", "2026-01-04", {"native_f64 kr5 inverse": [1.0]}), folder)
            self.assertEqual(titles(results.load(folder)), ["## A, 2026-01-04"])

    def test_robots_on_free_bases_are_held_against_their_own_bounds(self):
        times = {
            "native_f64 anymal inverse": [10.0],
            "casadi anymal inverse": [31.0],
            "cppadcodegen anymal inverse": [29.0],
            "pinocchio anymal inverse": [101.0],
            "f64x8 talos mass": [3.0],
            "f64x4 talos forward": [4.0],
            "cppadcodegen_x8 talos forward": [7.0],
            "cppadcodegen_x8 talos mass": [6.0],
        }
        found = outcomes(results.Times(run("A", "", times)))
        met = {(o.robot, o.function, o.least): (o.ratio, o.met) for o in found if o.ratio is not None}
        self.assertEqual(
            met,
            {
                ("anymal", "inverse", 3.0): (2.9, "**no**"),
                ("anymal", "inverse", 10.0): (10.1, "yes"),
                ("talos", "mass", 2.0): (2.0, "yes"),
                ("talos", "forward", 2.0): (1.75, "**no**"),
            },
        )

    def test_a_ratio_that_writing_alone_does_not_reach_is_reported_with_that_bound(self):
        times = {"f64x8 talos mass": [4.0], "cppadcodegen_x8 talos mass": [6.0], "written_x8 talos mass": [5.0]}

        def met() -> str:
            found = outcomes(results.Times(run("A", "", times)))
            return next(o.met for o in found if (o.robot, o.function, o.least) == ("talos", "mass", 2.0))

        self.assertEqual(met(), "**no**; writing alone gives 1.20")
        times["written_x8 talos mass"] = [2.0]
        self.assertEqual(met(), "**no**")

    def test_what_is_saved_is_read_again(self):
        with tempfile.TemporaryDirectory() as folder:
            saved = run("A", "2026-01-01", results.recorded({("native_f64", "kr5", "inverse"): [12.3456, 12.4]}))
            path = results.save(saved, Path(folder))
            self.assertEqual(json.loads(path.read_text()), saved)

    def test_native_code_may_be_slower_than_v3_by_the_spread_and_by_5_percent_at_most(self):
        def met(native: list[float], v3: list[float]) -> str:
            times = {"native_f64 kr5 inverse": native, "v3_f64 kr5 inverse": v3}
            found = outcomes(results.Times(run("A", "", times)))
            return next(o.met for o in found if "x86-64-v3" in o.asked and o.function == "inverse")

        self.assertEqual(met([10.0, 10.0, 10.0], [10.1, 10.1, 10.1]), "yes")
        self.assertEqual(met([10.0, 10.3, 10.6], [10.1, 10.1, 10.1]), "yes, within the spread")
        self.assertEqual(met([10.3, 10.3, 10.3], [10.1, 10.1, 10.1]), "**no**")
        self.assertEqual(met([10.0, 11.0, 12.0], [10.0, 10.0, 10.0]), "**no**")

    def test_the_page_and_its_pictures_are_what_the_results_give(self):
        docs = processor.REPOSITORY / "docs"
        runs = results.load(results.FOLDER)
        with tempfile.TemporaryDirectory() as folder:
            written = Path(folder)
            report.write(runs, written)
            for path in (path.relative_to(written) for path in written.rglob("*") if path.is_file()):
                hint = f"{path}: run peers/run --report-only"
                self.assertEqual((written / path).read_text(), (docs / path).read_text(), hint)


if __name__ == "__main__":
    unittest.main()
