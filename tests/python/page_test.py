import html.parser
import json

import pytest

import topple

BLOCK = """topple = 1
title = {title}
floor = {{}}
shake = [{shake}]
[run]
duration = 0.1
want = ["motion"]
[[block]]
size = [0.3, 0.6, 1.5]
mass = 60
"""
SINE = '{ type = "sine", frequency = 1, amplitude = 3 }'


class Tags(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.found = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.found.append((tag, dict(attributes)))


def page_of(result):
    """The document in the frame."""
    [(tag, attributes)] = Tags(result._repr_html_()).found
    assert tag == "iframe" and "height: 900px" in attributes["style"]
    return attributes["srcdoc"]


def data_of(page):
    return json.loads(page.split('<script id="data" type="application/json">')[1].split("</script>")[0])


@pytest.fixture(scope="module")
def written(program, recording, tmp_path_factory):
    """The page that the program writes of the recording."""
    file = tmp_path_factory.mktemp("page") / "paper-a.html"
    ended = program("export", recording, "--page", file)
    if ended.returncode != 0:
        assert "emscripten" in ended.stderr
        assert topple.open(recording)._repr_html_() is None
        pytest.skip("built without emscripten")
    return file.read_text()


def test_a_notebook_shows_the_page_that_the_program_writes(written, recording):
    assert page_of(topple.open(recording)) == written


def test_a_run_has_the_page_of_its_recording(written):
    mine, theirs = data_of(page_of(topple.Scene("paper-a").run())), data_of(written)
    for how_long in "live", "reason", "estimate_s":
        mine.pop(how_long), theirs.pop(how_long)
    assert mine == theirs


def test_texts_of_a_scene_stay_in_the_frame(written):
    title = '"></iframe><script>alert(1)</script>&quot;'
    page = page_of(topple.Scene.parse(BLOCK.format(title=json.dumps(title), shake=SINE)).run())
    assert [tag for tag, _ in Tags(page).found].count("script") == [tag for tag, _ in Tags(written).found].count("script")


def test_a_large_page_and_one_of_nothing_are_left_out(written, tmp_path):
    lines = "".join(f"{k / 100:.2f},0.{'0' * 40}\n" for k in range(200000))
    (tmp_path / "long.csv").write_text("time_s,ax_gal\n" + lines)
    text = BLOCK.format(title='"long"', shake='{ type = "record", files = ["long.csv"] }')
    result = topple.Scene.parse(text, str(tmp_path / "scene.toml")).run()
    assert result._repr_html_() is None and len(result._repr_png_()) > 1000
    assert topple.Scene("elements/cabinet-frame").run()._repr_html_() is None
