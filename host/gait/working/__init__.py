"""From tree to plan: names, values and blocks worked out for one robot."""
