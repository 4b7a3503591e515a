# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""bench/: calibrated sensors are never tested on their own scene; when a command is run again."""
import os
import stat
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))

import calibration  # noqa: E402
import units  # noqa: E402


def test_no_scene_is_tested_with_a_sensor_fitted_to_it():
    assert all(place != by for place, by in units.UNIT_OF.items())


def test_a_command_runs_again_where_something_changed(tmp_path):
    """The program counts its runs and fails on request."""
    program = tmp_path / "program"
    program.write_text(f"""#!/bin/sh
echo x >> {tmp_path}/runs
[ "$1" = fail ] && {{ echo 'wrong input' >&2; exit 65; }}
for last; do :; done
echo '{{"a": 1}}' > "$last"
""")
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    (tmp_path / "input").write_text("1")
    for file in (program, tmp_path / "input"):
        os.utime(file, (1e9, 1e9))
    report = tmp_path / "report.json"

    def runs_after(*words):
        assert calibration.report_of([program, *words], report) == {"a": 1}
        return len((tmp_path / "runs").read_text().split())

    assert runs_after(tmp_path / "input") == 1
    assert runs_after(tmp_path / "input") == 1
    assert runs_after(tmp_path / "input", "more") == 2
    os.utime(tmp_path / "input", (4e9, 4e9))
    assert runs_after(tmp_path / "input", "more") == 3
    with pytest.raises(SystemExit, match="wrong input"):
        calibration.report_of([program, "fail"], report)
    assert not report.exists()
