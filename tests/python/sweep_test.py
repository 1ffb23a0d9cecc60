import os
import signal
import threading
import time

import pytest

import topple


def without_clock(summary):
    """What two runs of one scene have in common."""
    return {key: value for key, value in summary.items() if key not in ("wall_s", "realtime_factor")}


def test_each_case_is_the_run_of_the_scene_with_its_keys():
    scene = topple.Scene("free-rocking")
    scene["run.duration"] = 0.3
    before = scene.text
    cases = [{"contact.friction": friction, "run.duration": "0.2 s"} for friction in (0.3, 0.4, 0.5, 0.6)] + [{}]
    swept = topple.sweep(scene, cases, jobs=3)
    assert scene.text == before
    assert len(swept) == len(cases)
    for case, summary in zip(cases, swept):
        alone = topple.Scene.parse(before, "free-rocking.toml")
        for key, value in case.items():
            alone[key] = value
        assert without_clock(summary) == without_clock(alone.run().summary)
    assert [without_clock(one) for one in topple.sweep(scene, cases, jobs=1)] == [without_clock(one) for one in swept]
    assert topple.sweep(scene, []) == []


@pytest.mark.parametrize("case", [{"contact.frictio": 1}, {"shake.9.amplitude": 1}, {"run.duration": "2 mm"}])
def test_a_wrong_case_is_refused_before_any_runs(case):
    scene = topple.Scene("free-rocking")
    scene["run.duration"] = 3600  # more than the test has
    with pytest.raises(topple.InputError):
        topple.sweep(scene, [{}, case])


def test_wrong_arguments_say_what_is_allowed():
    scene = topple.Scene("free-rocking")
    with pytest.raises(topple.InputError, match="jobs: 0 is outside 1..1024"):
        topple.sweep(scene, [{}], jobs=0)
    with pytest.raises(TypeError):
        topple.sweep(scene, [3])


def test_ctrl_c_ends_all_of_them():
    scene = topple.Scene("free-rocking")
    scene["run.duration"] = 3600
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        topple.sweep(scene, [{}] * 8, jobs=2)


def test_other_threads_go_on_meanwhile():
    scene = topple.Scene("free-rocking")
    scene["run.duration"] = 2
    beats, over = [], threading.Event()

    def beat():
        while not over.is_set():
            beats.append(time.monotonic())
            time.sleep(0.001)

    other = threading.Thread(target=beat)
    other.start()
    begun = time.monotonic()
    topple.sweep(scene, [{}] * 4)
    ended = time.monotonic()
    over.set()
    other.join()
    assert any(begun < at < ended for at in beats)
