"""The bodies of the robots as plants: power or angles in, shapes, temperatures and forces out."""
