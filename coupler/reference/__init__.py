"""What scenes, components and links may say: as text, as tables, and as a JSON schema."""
