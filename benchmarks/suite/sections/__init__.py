"""The sections of docs/benchmarks.md, in its order. Each has NAME, TITLE, measure(context), which returns
what JSON can hold, and page(data, images), which returns Markdown and writes plots into the folder."""

from suite.sections import formats, hybrid, micro, peers, radiosity, scaling

SECTIONS = {section.NAME: section for section in (radiosity, hybrid, formats, scaling, micro, peers)}
