"""Pictures of a script before it runs: its timeline with predicted temperatures, as SVG and in the terminal."""
