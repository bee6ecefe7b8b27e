"""From text to tree: the grammar, the lines before it, and what is said where a line cannot be read."""
