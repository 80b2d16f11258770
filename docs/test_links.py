"""What the check of links finds."""

import tempfile
import unittest
from pathlib import Path

from links import broken_links

HOME = """<h1 id="top">Home</h1><a href="#top">up</a><a href="docs/a.html#b%20c">a</a>
    <a href="https://example.org/x">out</a>"""
CHAPTER = '<h2 id="b c">A</h2><a href="../index.html">home</a><img src="a.svg"><object data="run.html"></object>'


class BrokenLinks(unittest.TestCase):
    def found(self, home=HOME, chapter=CHAPTER):
        with tempfile.TemporaryDirectory() as folder:
            site = Path(folder, "site")
            (site / "docs").mkdir(parents=True)
            Path(folder, "outside.html").write_text("")
            (site / "index.html").write_text(home)
            (site / "docs/a.html").write_text(chapter)
            for name in ("a.svg", "run.html"):
                (site / "docs" / name).write_text("")
            return broken_links(site)

    def test_a_site_whose_links_lead_somewhere_has_no_broken_link(self):
        self.assertEqual(self.found(), (5, []))

    def test_what_leads_nowhere_is_named_with_its_page(self):
        for element, address in [
            ('<a href="docs/b.html">', "docs/b.html"),
            ('<a href="docs">', "docs"),
            ('<a href="#bottom">', "#bottom"),
            ('<a href="docs/a.html#d">', "docs/a.html#d"),
            ('<a href="../outside.html">', "../outside.html"),
            ('<img src="a.svg">', "a.svg"),
            ('<object data="run.html"></object>', "run.html"),
        ]:
            self.assertEqual(self.found(home=element)[1], [f"index.html: {address}"])
        of_both = ["docs/a.html: index.html", "index.html: docs/a.html#b%20c"]
        self.assertEqual(self.found(chapter='<a href="index.html">')[1], of_both)


if __name__ == "__main__":
    unittest.main()
