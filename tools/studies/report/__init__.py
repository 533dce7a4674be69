"""The one report kit: charts as SVG, pages and tables as HTML."""
