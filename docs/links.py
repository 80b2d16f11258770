"""Checks that every link, picture and embedded page of a site leads to a file and, if it names one, to an anchor there.

    python3 docs/links.py target/book

Addresses of other hosts are not looked at.
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# The attributes that name a file, of which elements.
ADDRESSES = {"a": "href", "link": "href", "img": "src", "script": "src", "iframe": "src", "object": "data"}


class Page(HTMLParser):
    """The anchors of a page, and where its elements lead."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.addresses = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.anchors.update(filter(None, (attributes.get("id"), attributes.get("name"))))
        address = attributes.get(ADDRESSES.get(tag))
        if address is not None:
            self.addresses.append(address)


def broken_links(site):
    """How many addresses the pages of a site have, and those that lead nowhere, each after its page."""
    site = Path(site).resolve()
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(site.rglob("*.html"))}
    count, broken = 0, []
    for path, page in pages.items():
        for address in page.addresses:
            parts = urlsplit(address)
            if parts.scheme or parts.netloc:
                continue
            count += 1
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            anchor = unquote(parts.fragment)
            found = target.is_file() and target.is_relative_to(site)
            if not found or (anchor and target in pages and anchor not in pages[target].anchors):
                broken.append(f"{path.relative_to(site)}: {address}")
    return count, broken


if __name__ == "__main__":
    count, broken = broken_links(sys.argv[1])
    print(*broken, f"{count} links within the site, {len(broken)} of them broken", sep="\n")
    sys.exit(1 if broken or count == 0 else 0)
