"""What can go wrong on a bench: by name (table), when (happening, file), and what each fault does (parts, lines)."""
