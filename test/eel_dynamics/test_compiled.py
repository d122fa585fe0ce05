"""What a signal does that comes while loops are compiled, and what an upgrade finds that was compiled before."""

import pickle
import signal

import numba
import pytest
from eel_dynamics.compiled import compiled, inlined, shared


class Heard(Exception):
    pass


def hear(number, frame):
    raise Heard


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGALRM])
def test_a_signal_is_heard_once_the_function_is_compiled(monkeypatch, number):
    """What its handler raises within LLVM's call back would be lost, and the code with it."""

    @compiled
    def double(x):
        return 2.0 * x

    double._cache.flush()
    engine = double.targetctx.codegen()._engine._ee
    hand_over = engine._object_cache_notify

    def interrupted(module, code):
        signal.raise_signal(number)
        hand_over(module, code)

    before = signal.signal(number, hear)
    try:
        monkeypatch.setattr(engine, "_object_cache_notify", interrupted)
        with pytest.raises(Heard):
            double(3.0)
        monkeypatch.undo()
        assert signal.getsignal(number) is hear
        assert double(3.0) == 6.0 and len(double.overloads) == 1
        assert double._cache.load_overload(double.signatures[0], double.targetctx) is not None
        with pytest.raises(Heard):
            signal.raise_signal(number)
    finally:
        signal.signal(number, before)


def halving():
    @compiled
    def halve(x):
        return 0.5 * x

    return halve


def test_what_an_older_version_has_kept_may_be_of_types_that_are_gone():
    before = halving()
    before._cache.flush()
    assert before(3.0) == 1.5
    index = before._cache._cache_file._index_path
    gone = pickle.dumps(numba.__version__) + b"ceel_dynamics.kernel\nNoSuchType\n."
    with open(index, "wb") as file:
        file.write(gone)
    after = halving()
    assert after(3.0) == 1.5
    with open(index, "rb") as file:
        assert file.read() != gone
    again = halving()
    again(3.0)
    assert again.stats.cache_hits[again.signatures[0]] == 1


def test_what_is_for_loops_has_no_way_in_from_python_and_says_so():
    @inlined
    def third(x):
        return x / 3.0

    @shared
    def ninth(x):
        return third(third(x))

    for part in (third, ninth):
        part._cache.flush()
    assert ninth(9.0) == 1.0
    with pytest.raises(TypeError, match="third is for compiled loops to call"):
        third(9.0)
    assert len(third.overloads) == 1
